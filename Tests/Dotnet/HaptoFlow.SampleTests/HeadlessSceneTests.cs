using System.IO;
using System.Linq;
using HaptoFlow.SampleScenes;
using HaptoFlow.Tests.Support;
using Newtonsoft.Json.Linq;
using NUnit.Framework;
using UnityEngine;
using UnityShim;

namespace HaptoFlow.SampleTests
{
    /// <summary>StylusTracing.scene.json describes the same scene as the sample builds.</summary>
    public sealed class HeadlessSceneTests : SampleTest
    {
        private const float Same = 1e-5f;
        private JToken[] described = null!;

        [SetUp]
        public void BuildBoth()
        {
            string file = SampleFiles.In("StylusTracing", "StylusTracing.scene.json");
            described = JObject.Parse(File.ReadAllText(file))["surfaces"]!.ToArray();
            Camera camera = CameraOf(new SceneFile("StylusTracing"));
            Wake<TracingScene>(bootstrap => bootstrap.View = camera);
        }

        [Test]
        public void BothScenesHaveTheSameObjectsAndLabels()
        {
            Assert.That(described.Select(each => (string?)each["name"]),
                Is.EquivalentTo(Surfaces().Select(surface => surface.name)));
            foreach (HapticSurface surface in Surfaces())
            {
                var label = (string?)Of(surface)["material"];
                Assert.That(label, Is.EqualTo(surface.Material.Label), surface.name);
            }
        }

        [Test]
        public void BothScenesHaveTheSamePositionsAndAxes()
        {
            foreach (HapticSurface surface in Surfaces())
            {
                JToken rest = Of(surface);
                rest = rest["motion"]?["keyframes"]![0] ?? rest;
                Vector3 position = Vector(rest["position"]!);
                Assert.That(Vector3.Distance(surface.transform.position, position), Is.LessThan(Same), surface.name);
                Quaternion rotation = Rotation(rest);
                float likeness = Quaternion.Dot(surface.transform.rotation, rotation);
                Assert.That(likeness, Is.EqualTo(1f).Within(Same), surface.name);
                Vector3 grain = Of(surface)["grain"] is { } along ? Vector(along) : Vector3.right;
                Assert.That(surface.Grain, Is.EqualTo(grain), surface.name);
            }
        }

        [Test]
        public void BothScenesHaveTheSameShapesAndSizes()
        {
            foreach (HapticSurface surface in Surfaces())
            {
                JToken shape = Of(surface)["shape"]!;
                Vector3 scale = surface.transform.localScale;
                Vector3 size = surface.Colliders[0] switch
                {
                    BoxCollider box =>
                        Vector3.Scale(box.size, scale) - Vector(shape["box"]!["size"]!),
                    SphereCollider sphere => new Vector3(
                        sphere.radius * scale.x - (float)shape["sphere"]!["radius"]!,
                        scale.x - scale.y, scale.x - scale.z),
                    CapsuleCollider capsule => new Vector3(
                        capsule.radius * scale.x - (float)shape["capsule"]!["radius"]!,
                        capsule.height * scale.y - (float)shape["capsule"]!["height"]!,
                        scale.x - scale.z),
                    _ => Vector3.one,
                };
                Assert.That(size.magnitude, Is.LessThan(Same), surface.name);
            }
        }

        [Test]
        public void TheGrilleFollowsItsKeyframes()
        {
            Rigidbody grille = Surfaces().Single(surface => surface.name == "Sliding Grille").GetComponent<Rigidbody>();
            JToken motion = Of(grille.GetComponent<HapticSurface>())["motion"]!;
            Assert.That((bool)motion["loop"]!, Is.True);
            foreach (JToken keyframe in motion["keyframes"]!.Skip(1))
            {
                double seconds = (double)keyframe["t"]!;
                while (Clock.FixedSeconds < seconds - 1e-6)
                {
                    World.Frame();
                }
                Vector3 place = Vector(keyframe["position"]!);
                Assert.That(Vector3.Distance(grille.position, place), Is.LessThan(0.002f), $"{seconds} s");
            }
        }

        private JToken Of(HapticSurface surface) =>
            described.Single(each => (string?)each["name"] == surface.name);

        private static Quaternion Rotation(JToken pose) => pose["rotation"] is { } turned
            ? new Quaternion((float)turned[0]!, (float)turned[1]!, (float)turned[2]!, (float)turned[3]!)
            : Quaternion.identity;

        private static Vector3 Vector(JToken numbers) =>
            new Vector3((float)numbers[0]!, (float)numbers[1]!, (float)numbers[2]!);

        private static HapticSurface[] Surfaces() => UnityEngine.Object.FindObjectsByType<HapticSurface>(
            FindObjectsInactive.Exclude, FindObjectsSortMode.None);
    }
}
