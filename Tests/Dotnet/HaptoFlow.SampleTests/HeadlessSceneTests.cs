using System.IO;
using System.Linq;
using System.Text.Json;
using HaptoFlow.Samples.StylusTracing;
using NUnit.Framework;
using UnityEngine;
using UnityShim;

namespace HaptoFlow.SampleTests
{
    /// <summary>StylusTracing.scene.json describes the same scene as the sample builds.</summary>
    public sealed class HeadlessSceneTests : SampleTest
    {
        private const float Same = 1e-5f;
        private JsonElement[] described = null!;

        [SetUp]
        public void BuildBoth()
        {
            string file = SampleFile("StylusTracing", "StylusTracing.scene.json");
            using JsonDocument document = JsonDocument.Parse(File.ReadAllText(file));
            JsonElement surfaces = document.RootElement.GetProperty("surfaces");
            described = surfaces.EnumerateArray().Select(each => each.Clone()).ToArray();
            Camera camera = CameraOf(new SceneFile(SampleFile("StylusTracing", "StylusTracing.unity")));
            Wake<TracingScene>(bootstrap => bootstrap.View = camera);
        }

        [Test]
        public void BothScenesHaveTheSameObjectsAndLabels()
        {
            Assert.That(described.Select(each => each.GetProperty("name").GetString()),
                Is.EquivalentTo(Surfaces().Select(surface => surface.name)));
            foreach (HapticSurface surface in Surfaces())
            {
                string? label = Of(surface).GetProperty("material").GetString();
                Assert.That(label, Is.EqualTo(surface.Material.Label), surface.name);
            }
        }

        [Test]
        public void BothScenesHaveTheSamePositionsAndAxes()
        {
            foreach (HapticSurface surface in Surfaces())
            {
                JsonElement rest = Of(surface);
                bool moves = rest.TryGetProperty("motion", out JsonElement motion);
                rest = moves ? motion.GetProperty("keyframes")[0] : rest;
                Vector3 position = Vector(rest.GetProperty("position"));
                Assert.That(Vector3.Distance(surface.transform.position, position), Is.LessThan(Same), surface.name);
                Quaternion rotation = Rotation(rest);
                float likeness = Quaternion.Dot(surface.transform.rotation, rotation);
                Assert.That(likeness, Is.EqualTo(1f).Within(Same), surface.name);
                bool hasGrain = Of(surface).TryGetProperty("grain", out JsonElement along);
                Vector3 grain = hasGrain ? Vector(along) : Vector3.right;
                Assert.That(surface.Grain, Is.EqualTo(grain), surface.name);
            }
        }

        [Test]
        public void BothScenesHaveTheSameShapesAndSizes()
        {
            foreach (HapticSurface surface in Surfaces())
            {
                JsonElement shape = Of(surface).GetProperty("shape");
                Vector3 scale = surface.transform.localScale;
                Vector3 size = surface.Colliders[0] switch
                {
                    BoxCollider box =>
                        Vector3.Scale(box.size, scale) - Vector(shape.GetProperty("box").GetProperty("size")),
                    SphereCollider sphere => new Vector3(
                        sphere.radius * scale.x - shape.GetProperty("sphere").GetProperty("radius").GetSingle(),
                        scale.x - scale.y, scale.x - scale.z),
                    CapsuleCollider capsule => new Vector3(
                        capsule.radius * scale.x - shape.GetProperty("capsule").GetProperty("radius").GetSingle(),
                        capsule.height * scale.y - shape.GetProperty("capsule").GetProperty("height").GetSingle(),
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
            JsonElement motion = Of(grille.GetComponent<HapticSurface>()).GetProperty("motion");
            Assert.That(motion.GetProperty("loop").GetBoolean(), Is.True);
            foreach (JsonElement keyframe in motion.GetProperty("keyframes").EnumerateArray().Skip(1))
            {
                double seconds = keyframe.GetProperty("t").GetDouble();
                while (Clock.FixedSeconds < seconds - 1e-6)
                {
                    World.Frame();
                }
                Vector3 place = Vector(keyframe.GetProperty("position"));
                Assert.That(Vector3.Distance(grille.position, place), Is.LessThan(0.002f), $"{seconds} s");
            }
        }

        private JsonElement Of(HapticSurface surface) =>
            described.Single(each => each.GetProperty("name").GetString() == surface.name);

        private static Quaternion Rotation(JsonElement pose) => pose.TryGetProperty("rotation", out JsonElement turned)
            ? new Quaternion(turned[0].GetSingle(), turned[1].GetSingle(), turned[2].GetSingle(), turned[3].GetSingle())
            : Quaternion.identity;

        private static Vector3 Vector(JsonElement numbers) =>
            new Vector3(numbers[0].GetSingle(), numbers[1].GetSingle(), numbers[2].GetSingle());

        private static HapticSurface[] Surfaces() => UnityEngine.Object.FindObjectsByType<HapticSurface>(
            FindObjectsInactive.Exclude, FindObjectsSortMode.None);
    }
}
