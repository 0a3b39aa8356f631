using System;
using System.Collections.Generic;
using System.Linq;
using UnityEngine.Rendering;
using UnityShim;

namespace UnityEngine
{
    public sealed partial class Shader : Object
    {
        internal Shader(string name) => this.name = name;
    }

    public partial class Material
    {
        public Material(Shader shader) => this.shader = shader;

        public Material(Material source)
        {
            shader = source.shader;
            color = source.color;
            name = source.name;
            textures = new Dictionary<string, (Texture?, Vector2, Vector2)>(source.textures);
            floats = new Dictionary<string, float>(source.floats);
        }

        // The shim takes for a property of the shader what was set.
        private readonly Dictionary<string, (Texture? Texture, Vector2 Scale, Vector2 Offset)> textures =
            new Dictionary<string, (Texture?, Vector2, Vector2)>();

        private readonly Dictionary<string, float> floats = new Dictionary<string, float>();

        public bool HasProperty(string name) => textures.ContainsKey(name) || floats.ContainsKey(name);

        public Texture? GetTexture(string name) => Of(name).Texture;

        public void SetTexture(string name, Texture? value) =>
            textures[name] = (value, Of(name).Scale, Of(name).Offset);

        public Vector2 GetTextureScale(string name) => Of(name).Scale;

        public void SetTextureScale(string name, Vector2 value) =>
            textures[name] = (Of(name).Texture, value, Of(name).Offset);

        public Vector2 GetTextureOffset(string name) => Of(name).Offset;

        public void SetTextureOffset(string name, Vector2 value) =>
            textures[name] = (Of(name).Texture, Of(name).Scale, value);

        public float GetFloat(string name) => floats[name];

        public void SetFloat(string name, float value) => floats[name] = value;

        private (Texture? Texture, Vector2 Scale, Vector2 Offset) Of(string name) => textures.TryGetValue(
            name, out (Texture? Texture, Vector2 Scale, Vector2 Offset) found)
            ? found
            : (null, new Vector2(1f, 1f), Vector2.zero);

        public Shader? shader { get; set; }
    }

    public sealed partial class Camera
    {
        /// <summary>The first enabled camera of an active object with the tag MainCamera.</summary>
        public static Camera? main
        {
            get
            {
                for (int index = 0; index < World.AllObjects.Count; ++index)
                {
                    GameObject each = World.AllObjects[index];
                    if (each.IsMainCamera && each.activeInHierarchy && each.TryGetComponent(out Camera found) && found.enabled)
                    {
                        return found;
                    }
                }
                return null;
            }
        }
    }

    public sealed partial class GameObject
    {
        private string tagText = "Untagged";

        internal bool IsMainCamera => tagText == "MainCamera";

        /// <summary>Reading it allocates, as in Unity.</summary>
        public string tag
        {
            get => new string(tagText.AsSpan());
            set
            {
                UnityShim.ProjectNames.RequireTag(value);
                tagText = value;
            }
        }

        public bool CompareTag(string tag)
        {
            UnityShim.ProjectNames.RequireTag(tag);
            return tagText == tag;
        }

        public SceneManagement.Scene scene => transform.parent is { } parent ? parent.gameObject.scene : OwnScene;

        internal SceneManagement.Scene OwnScene;
    }

    [AttributeUsage(AttributeTargets.Class, AllowMultiple = true)]
    public sealed partial class RequireComponent : Attribute
    {
        public Type m_Type0;

        public RequireComponent(Type requiredComponent) => m_Type0 = requiredComponent;
    }

    public enum LightType
    {
        Directional = 1,
        Point = 2,
    }

    public enum LightShadows
    {
        None = 0,
        Soft = 2,
    }

    public sealed partial class Light : Behaviour
    {
        public LightType type { get; set; } = LightType.Point;
        public Color color { get; set; } = Color.white;
        public float intensity { get; set; } = 1f;
        public LightShadows shadows { get; set; }
    }

    public sealed partial class RenderSettings : Object
    {
        private RenderSettings()
        {
        }

        public static AmbientMode ambientMode { get; set; }
        public static Color ambientLight { get; set; }
    }

    public enum CameraClearFlags
    {
        Skybox = 1,
        SolidColor = 2,
        Depth = 3,
        Nothing = 4,
    }

    public sealed partial class Camera
    {
        public CameraClearFlags clearFlags { get; set; } = CameraClearFlags.Skybox;
        public Color backgroundColor { get; set; }
        public float nearClipPlane { get; set; } = 0.3f;
        public float farClipPlane { get; set; } = 1000f;
        public float depth { get; set; }
    }
}

namespace UnityEngine.Rendering
{
    public abstract partial class RenderPipelineAsset : ScriptableObject
    {
        public virtual Material? defaultMaterial => null;

        public virtual Shader? defaultShader => null;
    }

    public sealed partial class GraphicsSettings : Object
    {
        private GraphicsSettings()
        {
        }

        public static RenderPipelineAsset? defaultRenderPipeline { get; set; }

        public static RenderPipelineAsset? currentRenderPipeline => defaultRenderPipeline;
    }

    public enum AmbientMode
    {
        Skybox = 0,
        Flat = 3,
    }
}

namespace UnityShim
{
    /// <summary>A render pipeline that tests configure.</summary>
    public sealed class SimulatedPipeline : UnityEngine.Rendering.RenderPipelineAsset
    {
        /// <summary>The default material in the editor; null as in players with URP or HDRP.</summary>
        public UnityEngine.Material? Material { get; set; }

        /// <summary>The default shader; null as in players that were built without it.</summary>
        public UnityEngine.Shader? Shader { get; set; }

        public override UnityEngine.Material? defaultMaterial => Material;

        public override UnityEngine.Shader? defaultShader => Shader;

        public static UnityEngine.Shader ShaderNamed(string name) => new UnityEngine.Shader(name);
    }
}
