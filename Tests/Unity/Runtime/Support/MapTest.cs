#nullable enable
using System;
using System.Collections.Generic;
using NUnit.Framework;
using UnityEngine;
using Object = UnityEngine.Object;

namespace HaptoFlow.Tests
{
    /// <summary>A scene whose project has a map without rules. Assets created by a test are destroyed after
    /// it.</summary>
    public abstract class MapTest : SceneTest
    {
        internal HapticMaterialMap Map { get; private set; } = null!;

        [SetUp]
        public void LoadAndGiveTheProjectAMap()
        {
            Map = MapNamed("Project");
            HaptoFlowSettings.Active.MaterialMap = Map;
            FinishLoading();
        }

        internal HapticMaterialMap MapNamed(string name)
        {
            HapticMaterialMap map = Keep(ScriptableObject.CreateInstance<HapticMaterialMap>());
            map.name = name;
            return map;
        }

        /// <summary>A renderer's material.</summary>
        internal Material Paint(string name)
        {
            GameObject sphere = GameObject.CreatePrimitive(PrimitiveType.Sphere);
            Material paint = Keep(new Material(sphere.GetComponent<MeshRenderer>().sharedMaterial!) { name = name });
            Object.DestroyImmediate(sphere);
            return paint;
        }

        /// <summary>A board like that of <see cref="SceneTest.Board"/>, without a surface.</summary>
        internal BoxCollider Bare(string name = "Plank")
        {
            var box = Make(name).AddComponent<BoxCollider>();
            box.size = new Vector3(0.4f, 0.02f, 0.4f);
            box.center = new Vector3(0f, -0.01f, 0f);
            return box;
        }

        /// <summary>A stylus at rest 1 mm deep in the board.</summary>
        internal HapticStylus Resting(float x = 0f, float z = 0f) => StylusAlong(_ => new Vector3(x, 0.001f, z));

        /// <summary>The labels at the tip with their weights, in order of weight.</summary>
        internal static List<(string Label, float Weight)> Felt(HapticStylus stylus)
        {
            var felt = new List<(string, float)>();
            LabelBlend blend = stylus.IsTouching ? stylus.Contact.Labels : default;
            for (int index = 0; index < blend.Count; ++index)
            {
                felt.Add((HapticSession.Current.Labels.All[blend.Label(index)], blend.Weight(index)));
            }
            return felt;
        }

        internal static string FeltAlone(HapticStylus stylus)
        {
            List<(string Label, float Weight)> felt = Felt(stylus);
            Assert.That(felt, Has.Count.LessThanOrEqualTo(1));
            return felt.Count == 0 ? "" : felt[0].Label;
        }
    }
}
