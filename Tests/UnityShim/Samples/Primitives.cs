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

        public bool enabled { get; set; } = true;
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
}
