#nullable enable
using UnityEngine;
using UnityEngine.Rendering;

namespace HaptoFlow
{
    /// <summary>Assigns a material that the project's render pipeline supports: Built-in, URP or HDRP.</summary>
    /// <remarks>The material of Unity's primitives is pink in players with URP or HDRP, and those pipelines provide
    /// their default material only in the editor. The editor therefore writes it into this component whenever a scene
    /// is built or played, which also keeps its shader in the player. On an object with a renderer the component paints
    /// that renderer; on any object it makes the material available to <see cref="Paint"/>.</remarks>
    [AddComponentMenu("HaptoFlow/Pipeline Material")]
    [DefaultExecutionOrder(-1000)]
    [DisallowMultipleComponent]
    [HelpPage(HelpPages.Components + "pipeline-material")]
    public sealed class PipelineMaterial : MonoBehaviour
    {
        private static Material? ofScene;

        [SerializeField, Tooltip("The colour of the renderer on this object.")]
        private Color colour = Color.white;

        [SerializeField, Tooltip("The material. Leave it empty for the render pipeline's default, which builds and " +
            "play mode write here.")]
        private Material? material;

        /// <summary>Colour of the renderer on this object.</summary>
        public Color Colour
        {
            get => colour;
            set
            {
                colour = value;
                if (Application.isPlaying)
                {
                    PaintOwn();
                }
            }
        }

        /// <summary>The material; null for the render pipeline's default. Set it before the component awakes.</summary>
        public Material? Material { get => material; set => material = value; }

        /// <summary>Gives a renderer a coloured copy of the pipeline's material. Main thread, in play mode.</summary>
        public static void Paint(Renderer target, Color colour)
        {
            Apply(target, ofScene != null ? ofScene : OfPipeline(), colour);
        }

        /// <summary>The default material of the active render pipeline; null for the Built-in pipeline, whose
        /// primitives have one, and in players without the pipeline's shader.</summary>
        internal static Material? OfPipeline()
        {
            RenderPipelineAsset? pipeline = GraphicsSettings.currentRenderPipeline;
            if (pipeline == null)
            {
                return null;
            }
            Material? named = pipeline.defaultMaterial;
            if (named != null)
            {
                return named;
            }
            Shader? shader = pipeline.defaultShader;
            return shader != null ? new Material(shader) : null;
        }

        private static void Apply(Renderer target, Material? source, Color colour)
        {
            if (source != null)
            {
                target.sharedMaterial = source;
            }
            // Reading this property creates the renderer's own copy.
            target.material.color = colour;
        }

        private void Awake()
        {
            if (ofScene == null)
            {
                ofScene = material;
            }
            PaintOwn();
        }

        private void PaintOwn()
        {
            if (!TryGetComponent(out Renderer own))
            {
                return;
            }
            if (material != null)
            {
                Apply(own, material, colour);
            }
            else
            {
                Paint(own, colour);
            }
        }

        [RuntimeInitializeOnLoadMethod(RuntimeInitializeLoadType.SubsystemRegistration)]
        private static void Forget() => ofScene = null;
    }
}
