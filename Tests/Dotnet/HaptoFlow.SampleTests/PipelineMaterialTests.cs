using System.Linq;
using HaptoFlow.SampleScenes;
using NUnit.Framework;
using UnityEngine;
using UnityEngine.Rendering;
using UnityShim;

namespace HaptoFlow.SampleTests
{
    /// <summary>The materials that draw the samples' objects, in players and editors with the three render pipelines.
    /// </summary>
    public sealed class PipelineMaterialTests : SampleTest
    {
        [TearDown]
        public void RestoreTheBuiltInPipeline() => GraphicsSettings.defaultRenderPipeline = null;

        [Test]
        public void WithTheBuiltInPipelineObjectsKeepTheMaterialOfPrimitives()
        {
            OpenTracing(null);
            foreach (MeshRenderer renderer in Renderers())
            {
                Assert.That(renderer.sharedMaterial!.shader, Is.Null, renderer.name);
            }
            Assert.That(ColourOf("Table"), Is.EqualTo(Exhibits.All[0].Colour));
        }

        [Test]
        public void APlayerWithAnotherPipelineUsesTheMaterialThatTheBuildWrote()
        {
            Shader lit = SimulatedPipeline.ShaderNamed("Lit");
            // As in players with URP or HDRP, the pipeline has no default material.
            GraphicsSettings.defaultRenderPipeline = ScriptableObject.CreateInstance<SimulatedPipeline>();
            OpenTracing(new Material(lit));
            PlayFor(0.1);
            foreach (MeshRenderer renderer in Renderers())
            {
                Assert.That(renderer.sharedMaterial!.shader, Is.SameAs(lit), renderer.name);
            }
            Assert.That(ColourOf("Table"), Is.EqualTo(Exhibits.All[0].Colour));
            Assert.That(ColourOf("Sack"), Is.EqualTo(Exhibits.All[7].Colour), "each has a copy of its own");
        }

        [Test]
        public void TheEditorWithAnotherPipelineUsesItsDefaultMaterial()
        {
            Shader lit = SimulatedPipeline.ShaderNamed("Lit");
            var pipeline = ScriptableObject.CreateInstance<SimulatedPipeline>();
            pipeline.Material = new Material(lit);
            GraphicsSettings.defaultRenderPipeline = pipeline;
            OpenTracing(null);
            Assert.That(Renderers().Select(each => each.sharedMaterial!.shader), Is.All.SameAs(lit));
            Assert.That(pipeline.Material.color, Is.EqualTo(Color.white), "the pipeline's own material does not change");
        }

        [Test]
        public void APlayerWithThePipelinesShaderCreatesAMaterialFromIt()
        {
            Shader lit = SimulatedPipeline.ShaderNamed("Lit");
            var pipeline = ScriptableObject.CreateInstance<SimulatedPipeline>();
            pipeline.Shader = lit;
            GraphicsSettings.defaultRenderPipeline = pipeline;
            OpenTracing(null);
            Assert.That(Renderers().Select(each => each.sharedMaterial!.shader), Is.All.SameAs(lit));
        }

        private void OpenTracing(Material? written)
        {
            Camera camera = CameraOf(new SceneFile("StylusTracing"));
            Wake<TracingScene>(bootstrap =>
            {
                bootstrap.View = camera;
                bootstrap.GetComponent<PipelineMaterial>().Material = written;
            });
        }

        /// <summary>The renderers of the solids, without those of text, which have the material of their font.
        /// </summary>
        private static MeshRenderer[] Renderers()
        {
            MeshRenderer[] found = Object.FindObjectsByType<MeshRenderer>(
                FindObjectsInactive.Include, FindObjectsSortMode.None);
            MeshRenderer[] solids = found.Where(each => !each.TryGetComponent(out TextMesh _)).ToArray();
            Assert.That(solids.Length, Is.AtLeast(Exhibits.All.Length + 3), "exhibits and three pens");
            return solids;
        }

        private static Color ColourOf(string name) => Renderers().Single(each => each.name == name).material.color;
    }
}
