using System;
using System.IO;
using System.Linq;
using HaptoFlow.SampleScenes;
using HaptoFlow.Samples.LatencyStudy;
using HaptoFlow.Samples.SimilarityStudy;
using HaptoFlow.Tests.Support;
using NUnit.Framework;
using Newtonsoft.Json.Linq;
using UnityEngine;
using UnityEngine.Rendering;
using UnityShim;
using Object = UnityEngine.Object;

namespace HaptoFlow.SampleTests
{
    /// <summary>What the scene view shows of a sample before play mode is what play mode builds.</summary>
    public sealed class SketchTests : SampleTest
    {
        [SetUp]
        public void Clear() => Gizmos.Solids.Clear();

        [Test]
        public void StylusTracingSketchesItsObjects() => Check<TracingScene>("StylusTracing", 8);

        [Test]
        public void TextureGallerySketchesATileForEachLabelAndTheBoard() => Check<GalleryScene>("TextureGallery", 21);

        [Test]
        public void WorkshopSketchesItsBench() => Check<WorkshopScene>("Workshop", 6);

        [Test]
        public void DeviceCheckSketchesItsPlates() => Check<DeviceCheckScene>("DeviceCheck", 3);

        [Test]
        public void LatencyStudySketchesItsPlate() => Check<LatencyStudyScene>("LatencyStudy", 1);

        [Test]
        public void SimilarityStudySketchesBothObjectsAndNothingWithoutSettings()
        {
            GameObject owner = Make("Bootstrap");
            owner.SetActive(false);
            var scene = owner.AddComponent<SimilarityStudyScene>();
            scene.Sketch();
            Assert.That(Gizmos.Solids, Is.Empty);
            var settings = ScriptableObject.CreateInstance<SimilarityStudySettings>();
            scene.Settings = settings;
            scene.Sketch();
            Assert.That(Gizmos.Solids, Has.Count.EqualTo(2));
            Assert.That(Gizmos.Solids.Select(solid => solid.Size), Is.All.EqualTo(settings.sampleMetres));
            Assert.That(Gizmos.Solids[1].Position - Gizmos.Solids[0].Position, Is.EqualTo(settings.virtualMetres));
        }

        private void Check<TScene>(string sample, int solids)
            where TScene : BuiltScene
        {
            TScene scene = Open<TScene>(sample, each =>
            {
                camera.gameObject.AddComponent<AudioListener>();
                each.Sketch();
            });
            Assert.That(Gizmos.Solids, Has.Count.EqualTo(solids));
            (Vector3 Centre, Vector3 Size)[] built = World.AllObjects
                .Select(each => each.TryGetComponent(out Collider collider) ? collider : null)
                .Where(each => each != null && each.enabled).Select(each => ExtentOf(each!)).ToArray();
            foreach ((Vector3 position, Quaternion _, Vector3 size, Color _) in Gizmos.Solids)
            {
                // A solid of the same outline and the same top: a felt sheet has no height.
                Assert.That(built.Any(each =>
                    Vector3.Distance(Top(each.Centre, each.Size), Top(position, size)) < 1e-4f &&
                    Math.Abs(each.Size.x - size.x) < 1e-3f && Math.Abs(each.Size.z - size.z) < 1e-3f),
                    Is.True, $"{scene.name}: {position}, {size}");
            }
        }

        private static Vector3 Top(Vector3 centre, Vector3 size) => centre + new Vector3(0f, 0.5f * size.y, 0f);

        private static (Vector3 Centre, Vector3 Size) ExtentOf(Collider collider)
        {
            Vector3 place = collider.transform.position;
            Vector3 scale = collider.transform.localScale;
            return collider switch
            {
                MeshCollider mesh => (place + mesh.sharedMesh!.bounds.center, mesh.sharedMesh.bounds.size),
                TerrainCollider terrain => (place + 0.5f * terrain.terrainData!.size, terrain.terrainData.size),
                // Unity's capsule is two units high.
                CapsuleCollider _ => (place, new Vector3(scale.x, 2f * scale.y, scale.z)),
                _ => (place, scale),
            };
        }
    }

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
            Open<TracingScene>("StylusTracing");
        }

        [Test]
        public void BothScenesHaveTheSameObjectsAndLabels()
        {
            Assert.That(described.Select(each => (string?)each["name"]),
                Is.EquivalentTo(Surfaces().Select(surface => surface.name)));
            Assert.That(Surfaces().Select(surface => (string?)Of(surface)["material"]),
                Is.EqualTo(Surfaces().Select(surface => surface.Material.Label)));
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

        private static HapticSurface[] Surfaces() => All<HapticSurface>();
    }

    /// <summary>The materials that draw the samples' objects, in players and editors with the three render pipelines.
    /// </summary>
    public sealed class PipelineMaterialTests : SampleTest
    {
        private readonly Shader lit = SimulatedPipeline.ShaderNamed("Lit");
        private SimulatedPipeline pipeline = null!;

        [SetUp]
        public void MakeAPipeline() => pipeline = ScriptableObject.CreateInstance<SimulatedPipeline>();

        [TearDown]
        public void RestoreTheBuiltInPipeline() => GraphicsSettings.defaultRenderPipeline = null;

        [Test]
        public void WithTheBuiltInPipelineObjectsKeepTheMaterialOfPrimitives()
        {
            OpenTracing(null);
            Assert.That(Renderers().Select(each => each.sharedMaterial!.shader), Is.All.Null);
            Assert.That(ColourOf("Table"), Is.EqualTo(Exhibits.All[0].Colour));
        }

        [Test]
        public void APlayerWithAnotherPipelineUsesTheMaterialThatTheBuildWrote()
        {
            // As in players with URP or HDRP, the pipeline has no default material.
            GraphicsSettings.defaultRenderPipeline = pipeline;
            OpenTracing(new Material(lit));
            PlayFor(0.1);
            Assert.That(Renderers().Select(each => each.sharedMaterial!.shader), Is.All.SameAs(lit));
            Assert.That(ColourOf("Table"), Is.EqualTo(Exhibits.All[0].Colour));
            Assert.That(ColourOf("Sack"), Is.EqualTo(Exhibits.All[7].Colour), "each has a copy of its own");
        }

        [Test]
        public void TheEditorWithAnotherPipelineUsesItsDefaultMaterial()
        {
            pipeline.Material = new Material(lit);
            GraphicsSettings.defaultRenderPipeline = pipeline;
            OpenTracing(null);
            Assert.That(Renderers().Select(each => each.sharedMaterial!.shader), Is.All.SameAs(lit));
            Assert.That(pipeline.Material.color, Is.EqualTo(Color.white), "the pipeline's own material does not change");
        }

        [Test]
        public void APlayerWithThePipelinesShaderCreatesAMaterialFromIt()
        {
            pipeline.Shader = lit;
            GraphicsSettings.defaultRenderPipeline = pipeline;
            OpenTracing(null);
            Assert.That(Renderers().Select(each => each.sharedMaterial!.shader), Is.All.SameAs(lit));
        }

        private void OpenTracing(Material? written) => Open<TracingScene>(
            "StylusTracing", scene => scene.GetComponent<PipelineMaterial>().Material = written);

        /// <summary>The renderers of the solids, without those of text, which have the material of their font.
        /// </summary>
        private static MeshRenderer[] Renderers()
        {
            MeshRenderer[] solids = All<MeshRenderer>().Where(each => !each.TryGetComponent(out TextMesh _)).ToArray();
            Assert.That(solids.Length, Is.AtLeast(Exhibits.All.Length + 3), "exhibits and three pens");
            return solids;
        }

        private static Color ColourOf(string name) => Renderers().Single(each => each.name == name).material.color;
    }
}
