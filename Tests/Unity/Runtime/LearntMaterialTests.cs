#nullable enable
using System;
using System.Collections;
using System.Linq;
using System.Text.RegularExpressions;
using HaptoFlow.Model;
using NUnit.Framework;
using UnityEngine;
using UnityEngine.TestTools;
using Object = UnityEngine.Object;

namespace HaptoFlow.Tests
{
    /// <summary>Haptic Materials with an embedding of their own, in a running scene.</summary>
    public sealed class LearntMaterialTests : SceneTest
    {
        private const int LabelCount = 20;

        private static HapticSession Session => HapticSession.Current;

        private static string Text(string label, params (string Key, object? Value)[] changes)
        {
            MaterialFile plain = MaterialFile.Read(MaterialText.OfLabel(DefaultModel.Asset().File, label));
            return MaterialText.With(plain, changes.ToDictionary(each => each.Key, each => each.Value));
        }

        private HapticMaterial Learnt(string of, string label, params (string Key, object? Value)[] changes) =>
            Keep(HapticMaterial.Create(Text(of, changes), label));

        private HapticSurface Board(HapticMaterial material)
        {
            HapticSurface board = Board();
            board.SharedMaterial = material;
            return board;
        }

        private static LabelBlend BlendOf(HapticSurface surface)
        {
            _ = surface.LookUp(Session);
            Session.FinishRegistrations();
            return surface.LookUp(Session).Labels;
        }

        [UnityTest]
        public IEnumerator ALearntMaterialIsFeltInAdditionToTheLabels()
        {
            FinishLoading();
            HapticSurface board = Board(Learnt("glass", "fur", ("stiffness_newtons_per_metre", 432.0)));
            LabelBlend blend = BlendOf(board);
            Assert.That((blend.Count, blend.Label(0), blend.Weight(0)), Is.EqualTo((1, LabelCount, 1f)));
            Assert.That(board.LookUp(Session).StiffnessNewtonsPerMetre, Is.EqualTo(432.0));
            Assert.That((Haptics.LearntMaterials, Haptics.RefusedMaterials), Is.EqualTo((1, 0)));
            AudioTap tap = Output(out _);
            HapticStylus stylus = Circling();
            yield return Frames(40);
            Assert.That(stylus.IsTouching, Is.True);
            Assert.That(tap.Peak(), Is.GreaterThan(0.001f));
        }

        [Test]
        public void TheLabelIsFeltWhileTheMaterialIsBeingRegistered()
        {
            HapticSurface board = Board(Learnt("glass", "fur"));
            FinishLoading();
            Assert.That(board.LookUp(Session).Labels.Label(0), Is.EqualTo(Session.Labels.All.ToList().IndexOf("fur")));
            Session.FinishRegistrations();
            Assert.That(board.LookUp(Session).Labels.Label(0), Is.EqualTo(LabelCount));
        }

        [Test]
        public void MaterialsOfSurfacesAreRegisteredBeforeTheyAreTouched()
        {
            Board(Learnt("glass", "fur"));
            FinishLoading();
            Board(Learnt("stone", "fur"));
            Session.FinishRegistrations();
            Assert.That(Haptics.LearntMaterials, Is.EqualTo(2), "nothing was touched");
        }

        [UnityTest]
        public IEnumerator ALearntMaterialOfARuleIsRegisteredAndFelt()
        {
            HapticMaterial material = Learnt("glass", "fur");
            Bare("Plate");
            HapticMaterialMap map = Keep(ScriptableObject.CreateInstance<HapticMaterialMap>());
            map.Add(HapticMaterialRule.ForName("Plate", material));
            Make("Scope").AddComponent<HapticMaterialMapScope>().Map = map;
            FinishLoading();
            Session.FinishRegistrations();
            Assert.That(Haptics.LearntMaterials, Is.EqualTo(1), "nothing was touched");
            HapticStylus stylus = Circling();
            yield return Frames(20);
            Assert.That(stylus.IsTouching, Is.True);
            Assert.That(stylus.Contact.Labels.Label(0), Is.EqualTo(LabelCount));
        }

        [Test]
        public void ACopyOfALearntMaterialStaysLearntAndBlendsWithLabels()
        {
            FinishLoading();
            HapticMaterial shared = Learnt("glass", "fur");
            HapticSurface board = Board(shared);
            board.Material.Strength = 0.5f;
            Assert.That(board.SharedMaterial, Is.Null);
            Assert.That(board.Material.Learnt, Is.SameAs(shared));
            board.Material.SecondLabel = "wood";
            board.Material.Blend = 0.25f;
            LabelBlend blend = BlendOf(board);
            Assert.That((blend.Count, blend.Label(0), blend.Label(1)), Is.EqualTo((2, LabelCount, 0)));
            board.Material.Learnt = null;
            Assert.That(board.LookUp(Session).Labels.Label(0), Is.LessThan(LabelCount));
        }

        [Test]
        public void AMaterialOfAnotherModelIsFeltAsItsLabelWithOneWarningThatNamesTheRemedy()
        {
            FinishLoading();
            LogAssert.Expect(LogType.Warning, new Regex(
                "foreign is felt as its label \"fur\": it was learnt for another model .*0badcafe.*Learn it again"));
            HapticMaterial foreign = Learnt("glass", "fur", ("space", "0badcafe"));
            foreign.name = "foreign";
            using var log = new LogRecord();
            foreach (int _ in Enumerable.Range(0, 3))
            {
                Assert.That(BlendOf(Board(foreign)).Label(0), Is.EqualTo(Session.Labels.All.ToList().IndexOf("fur")));
            }
            Assert.That(log.Lines, Has.Count.EqualTo(1));
            Assert.That((Haptics.LearntMaterials, Haptics.RefusedMaterials), Is.EqualTo((0, 1)));
        }

        [UnityTest]
        public IEnumerator ANewTextReplacesTheMaterialDuringATouch()
        {
            FinishLoading();
            HapticMaterial material = Learnt("glass", "fur", ("stiffness_newtons_per_metre", 300.0));
            HapticSurface board = Board(material);
            HapticStylus stylus = Circling();
            yield return Frames(10);
            Assert.That(BlendOf(board).Label(0), Is.EqualTo(LabelCount));
            material.Carry(Text("sandpaper", ("stiffness_newtons_per_metre", 600.0)));
            Session.FinishRegistrations();
            Assert.That((BlendOf(board).Label(0), Haptics.LearntMaterials), Is.EqualTo((LabelCount, 1)));
            Assert.That(board.LookUp(Session).StiffnessNewtonsPerMetre, Is.EqualTo(600.0));
            material.Carry("");
            Assert.That(board.LookUp(Session).Labels.Label(0), Is.EqualTo(Session.Labels.All.ToList().IndexOf("fur")));
            Assert.That(Haptics.LearntMaterials, Is.Zero);
            yield return null;
            Assert.That(stylus.IsTouching, Is.True);
        }

        [Test]
        public void SixOfSeventyMaterialsExceedTheLimitAndAFreedIndexGoesToTheFirstThatWaits()
        {
            FinishLoading();
            LogAssert.ignoreFailingMessages = true;
            using var log = new LogRecord();
            HapticSurface[] boards = Enumerable.Range(0, 70)
                .Select(number => Board(Learnt("glass", "fur", ("name", "glass " + number)))).ToArray();
            Session.FinishRegistrations();
            Assert.That((Haptics.LearntMaterials, Haptics.RefusedMaterials), Is.EqualTo((64, 6)));
            Assert.That(log.Lines.Select(line => line.Text),
                Has.Exactly(6).Items.And.All.Contains("64 learnt materials are in use"));
            Assert.That(boards.Select(board => board.LookUp(Session).Labels.Label(0)).Distinct().Count(), Is.EqualTo(65));
            Object.DestroyImmediate(boards[3].SharedMaterial!);
            Session.FinishRegistrations();
            Assert.That(BlendOf(boards[64]).Label(0), Is.EqualTo(LabelCount + 3));
            Assert.That((Haptics.LearntMaterials, Haptics.RefusedMaterials), Is.EqualTo((64, 5)));
        }

        [Test]
        public void AMaterialDestroyedDuringRegistrationFreesItsIndex()
        {
            FinishLoading();
            foreach (int _ in Enumerable.Range(0, 80))
            {
                HapticMaterial material = Learnt("glass", "fur");
                Board(material);
                Object.DestroyImmediate(material);
                Session.FinishRegistrations();
            }
            Assert.That((Haptics.LearntMaterials, Haptics.RefusedMaterials), Is.EqualTo((0, 0)));
            Assert.That(BlendOf(Board(Learnt("glass", "fur"))).Label(0), Is.GreaterThanOrEqualTo(LabelCount));
        }

        [Test]
        public void ClosingAnEngineWaitsForRegistrationsUnderWay()
        {
            FinishLoading();
            foreach (int number in Enumerable.Range(0, 20))
            {
                Board(Learnt("glass", "fur", ("name", "glass " + number)));
            }
            Haptics.Restart();
            Assert.That(HapticSession.Existing, Is.Null);
            FinishLoading();
            Session.FinishRegistrations();
            Assert.That(Haptics.LearntMaterials, Is.EqualTo(20));
        }

        [Test]
        public void AnInvalidTextIsRefusedByItsKeyAndChangesNothing()
        {
            HapticMaterial material = Learnt("glass", "fur");
            string before = material.Learnt;
            var refusal = Assert.Throws<HaptoFlowException>(() => material.Carry(before.Replace("\"embedding\"", "\"e\"")));
            Assert.That(refusal!.Message, Does.Contain("expected a member \"embedding\""));
            Assert.That(material.Learnt, Is.EqualTo(before));
            Assert.Throws<HaptoFlowException>(() => HapticMaterial.Create("{}", "fur"));
        }
    }
}
