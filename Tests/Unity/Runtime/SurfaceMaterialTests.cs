#nullable enable
using System.Collections;
using NUnit.Framework;
using UnityEngine;
using UnityEngine.TestTools;

namespace HaptoFlow.Tests
{
    /// <summary>Own and shared materials behave like Renderer.material and Renderer.sharedMaterial.</summary>
    public sealed class SurfaceMaterialTests : SceneTest
    {
        [UnityTest]
        public IEnumerator ChangingASurfacesMaterialChangesNeitherTheAssetNorItsOtherUsers()
        {
            FinishLoading();
            HapticMaterial shared = Shared();
            HapticSurface first = Board();
            HapticSurface second = Board();
            first.SharedMaterial = shared;
            second.SharedMaterial = shared;
            LabelBlend glass = second.LookUp(HapticSession.Current).Labels;
            first.Material.Label = "rubber";
            Assert.That(shared.Description.Label, Is.EqualTo("glass"));
            Assert.That(second.LookUp(HapticSession.Current).Labels, Is.EqualTo(glass));
            Assert.That(first.LookUp(HapticSession.Current).Labels, Is.Not.EqualTo(glass));
            Assert.That(first.SharedMaterial, Is.Null);
            yield return null;
        }

        [UnityTest]
        public IEnumerator TheOwnCopyStartsEqualToTheSharedMaterial()
        {
            HapticMaterial shared = Shared();
            HapticSurface board = Board("fur");
            board.SharedMaterial = shared;
            MaterialDescription own = board.Material;
            Assert.That(own, Is.Not.SameAs(shared.Description));
            Assert.That(own.Label, Is.EqualTo("glass"));
            Assert.That(own.SecondLabel, Is.EqualTo("stone"));
            Assert.That(own.Blend, Is.EqualTo(0.25f));
            Assert.That(own.StiffnessNewtonsPerMetre, Is.EqualTo(321f));
            Assert.That(own.Strength, Is.EqualTo(0.5f));
            Assert.That(own.FeatureScale, Is.EqualTo(2f));
            Assert.That(own.ToneDbPerOctave, Is.EqualTo(-3f));
            Assert.That(board.Material, Is.SameAs(own), "a second read returns the same copy");
            yield return null;
        }

        [UnityTest]
        public IEnumerator ReadingSharedDescriptionKeepsTheSharedMaterial()
        {
            HapticMaterial shared = Shared();
            HapticSurface board = Board();
            board.SharedMaterial = shared;
            HapticStylus stylus = StylusAlong(_ => new Vector3(0f, 0.001f, 0f));
            yield return Frames(2);
            Assert.That(stylus.IsTouching, Is.True);
            Assert.That(board.SharedDescription, Is.SameAs(shared.Description));
            Assert.That(board.SharedMaterial, Is.SameAs(shared));
            board.SharedMaterial = null;
            Assert.That(board.SharedDescription, Is.SameAs(board.Material));
        }

        [UnityTest]
        public IEnumerator FeatureScaleAndToneAreLimitedToTheirRanges()
        {
            var material = new MaterialDescription();
            Assert.That(material.FeatureScale, Is.EqualTo(1f), "the default leaves features unchanged");
            Assert.That(material.ToneDbPerOctave, Is.Zero, "no tilt");
            material.FeatureScale = 9f;
            material.ToneDbPerOctave = 40f;
            Assert.That(material.FeatureScale, Is.EqualTo(4f));
            Assert.That(material.ToneDbPerOctave, Is.EqualTo(12f));
            material.FeatureScale = 0f;
            material.ToneDbPerOctave = -40f;
            Assert.That(material.FeatureScale, Is.EqualTo(0.25f));
            Assert.That(material.ToneDbPerOctave, Is.EqualTo(-12f));
            yield return null;
        }

        private static HapticMaterial Shared()
        {
            var shared = ScriptableObject.CreateInstance<HapticMaterial>();
            shared.Description.Label = "glass";
            shared.Description.SecondLabel = "stone";
            shared.Description.Blend = 0.25f;
            shared.Description.StiffnessNewtonsPerMetre = 321f;
            shared.Description.Strength = 0.5f;
            shared.Description.FeatureScale = 2f;
            shared.Description.ToneDbPerOctave = -3f;
            return shared;
        }
    }
}
