using System;
using System.Collections.Generic;

namespace UnityEngine
{
    public enum PrimitiveType
    {
        Sphere = 0,
        Capsule = 1,
        Cylinder = 2,
        Cube = 3,
        Plane = 4,
        Quad = 5,
    }

    public partial class Renderer : Component
    {
        private Material? shown = new Material();
        private Material[]? several;
        private bool isOwn;

        /// <summary>Reading it creates the renderer's own copy, as in Unity.</summary>
        public Material material
        {
            get
            {
                if (!isOwn)
                {
                    shown = new Material(shown!);
                    isOwn = true;
                }
                return shown!;
            }
            set => sharedMaterial = value;
        }

        public Material? sharedMaterial
        {
            get => shown;
            set
            {
                shown = value;
                isOwn = false;
                several = several != null && several.Length > 0 && ReferenceEquals(several[0], value) ? several : null;
            }
        }

        /// <summary>Reading allocates, as in Unity. Unlike in Unity, materials set as a list are not copied.</summary>
        public Material[] sharedMaterials
        {
            get => several ?? (shown == null ? System.Array.Empty<Material>() : new[] { shown });
            set
            {
                several = value;
                sharedMaterial = value.Length > 0 ? value[0] : null;
            }
        }

        public void GetSharedMaterials(List<Material> m)
        {
            m.Clear();
            if (several != null)
            {
                m.AddRange(several);
            }
            else if (shown is object)
            {
                m.Add(shown);
            }
        }
    }

    public partial class SkinnedMeshRenderer : Renderer
    {
    }

    public sealed partial class TrailRenderer : Renderer
    {
    }

    public partial class MeshRenderer : Renderer
    {
    }

    public sealed partial class MeshFilter : Component
    {
        public Mesh? sharedMesh { get; set; }
    }

    public partial class Material : Object
    {
        internal Material()
        {
        }

        public Color color { get; set; } = Color.white;

        public Texture? mainTexture { get; set; }
    }

    public sealed partial class GameObject
    {
        /// <summary>Creates a primitive with the collider of one unit that Unity gives it.</summary>
        public static GameObject CreatePrimitive(PrimitiveType type)
        {
            var made = new GameObject(type.ToString());
            made.AddComponent<MeshFilter>();
            made.AddComponent<MeshRenderer>();
            switch (type)
            {
                case PrimitiveType.Sphere:
                    made.AddComponent<SphereCollider>();
                    break;
                case PrimitiveType.Capsule:
                case PrimitiveType.Cylinder:
                    made.AddComponent<CapsuleCollider>();
                    break;
                case PrimitiveType.Cube:
                    made.AddComponent<BoxCollider>();
                    break;
                default:
                    throw new System.NotSupportedException("the shim makes no mesh colliders for planes and quads");
            }
            return made;
        }
    }

    /// <summary>A pinhole camera with a screen of 1280 x 720 pixels.</summary>
    public sealed partial class Camera : Behaviour
    {
        public float fieldOfView { get; set; } = 60f;
        public int pixelWidth => 1280;
        public int pixelHeight => 720;

        public Ray ScreenPointToRay(Vector3 pos)
        {
            float scale = PixelSize();
            var local = new Vector3((pos.x - 0.5f * pixelWidth) * scale, (pos.y - 0.5f * pixelHeight) * scale, 1f);
            return new Ray(transform.position, transform.rotation * local);
        }

        public Vector3 WorldToScreenPoint(Vector3 position)
        {
            Vector3 local = Quaternion.Inverse(transform.rotation) * (position - transform.position);
            float scale = PixelSize() * local.z;
            return new Vector3(0.5f * pixelWidth + local.x / scale, 0.5f * pixelHeight + local.y / scale, local.z);
        }

        /// <summary>The size of a pixel at a distance of one metre.</summary>
        private float PixelSize() => (float)Math.Tan(0.5 * fieldOfView * Math.PI / 180.0) / (0.5f * pixelHeight);
    }

    public partial struct Color
    {
        /// <summary>Converts HSV to RGB after Smith, Color gamut transform pairs, 1978.</summary>
        public static Color HSVToRGB(float H, float S, float V)
        {
            float Channel(float shift)
            {
                float place = (shift + 6f * H) % 6f;
                return V - V * S * Math.Max(0f, Math.Min(1f, Math.Min(place, 4f - place)));
            }
            return new Color(Channel(5f), Channel(3f), Channel(1f));
        }
    }

    public enum TextAnchor
    {
        MiddleLeft = 3,
        MiddleCenter = 4,
        MiddleRight = 5,
    }

    public enum TextAlignment
    {
        Left = 0,
        Center = 1,
        Right = 2,
    }

    public sealed partial class Font : Object
    {
        public Material material { get; set; } = new Material();
    }

    public sealed partial class TextMesh : Component
    {
        public string text { get; set; } = "";
        public Font font { get; set; } = null!;
        public int fontSize { get; set; }
        public TextAlignment alignment { get; set; }
        public TextAnchor anchor { get; set; }
        public float characterSize { get; set; } = 1f;
        public Color color { get; set; } = Color.white;
    }

    public sealed partial class Resources
    {
        /// <summary>Unity has a few built-in resources under fixed names, and returns null for any other name.
        /// </summary>
        public static T GetBuiltinResource<T>(string path)
            where T : Object =>
            typeof(T) == typeof(Font) && path == "LegacyRuntime.ttf" ? (T)(Object)new Font() : null!;
    }
}
