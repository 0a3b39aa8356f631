#nullable enable
using System;
using UnityEngine;
#if UNITY_6000_0_OR_NEWER
using SurfacePhysics = UnityEngine.PhysicsMaterial;
#else
using SurfacePhysics = UnityEngine.PhysicMaterial;
#endif

namespace HaptoFlow
{
    /// <summary>The property of an object that a rule matches.</summary>
    public enum MaterialRuleSubject
    {
        /// <summary>The Unity tag of the collider's object.</summary>
        Tag = 0,

        /// <summary>The layer of the collider's object.</summary>
        Layer = 1,

        /// <summary>The collider's physics material.</summary>
        PhysicsMaterial = 2,

        /// <summary>A material of the object's renderer; on a mesh collider each submesh is matched by its
        /// own.</summary>
        RendererMaterial = 3,

        /// <summary>A layer of a terrain.</summary>
        TerrainLayer = 4,

        /// <summary>A submesh of a mesh collider, by its number.</summary>
        Submesh = 5,

        /// <summary>The name of the collider's object, by a pattern with <c>*</c>.</summary>
        Name = 6,
    }

    /// <summary>One rule of a <see cref="HapticMaterialMap"/>: what it matches, and the material that it
    /// assigns.</summary>
    [Serializable]
    public sealed class HapticMaterialRule
    {
        [SerializeField, Tooltip("The rule compares this property of an object.")]
        private MaterialRuleSubject subject = MaterialRuleSubject.Tag;

        [SerializeField, Tooltip("The rule matches colliders whose object has this Unity tag.")]
        private string tag = "";

        [SerializeField, Tooltip("The rule matches colliders whose object is on this layer.")]
        private int layer;

        [SerializeField, Tooltip("The rule matches colliders with this physics material.")]
        private SurfacePhysics? physicsMaterial;

        [SerializeField, Tooltip("The rule matches this material of the object's renderer. A mesh collider is " +
            "compared by submesh, any other collider by the first material.")]
        private Material? rendererMaterial;

        [SerializeField, Tooltip("The rule matches this layer of a terrain. Where several layers are painted, their " +
            "materials are blended.")]
        private TerrainLayer? terrainLayer;

        [SerializeField, Tooltip("The rule matches a submesh of this mesh. When it is empty, it matches every mesh.")]
        private Mesh? mesh;

        [SerializeField, Min(0), Tooltip("The rule matches the submesh of this number, counted from 0.")]
        private int submesh;

        [SerializeField, Tooltip("The rule matches colliders whose object has this name. A * stands for any " +
            "characters; case is ignored.")]
        private string namePattern = "";

        [SerializeField, Tooltip("Matching objects have this material. When it is empty they are not felt, and no " +
            "later rule applies.")]
        private HapticMaterial? material;

        [SerializeField, Tooltip("The mask selects further materials by a texture at the touched point. It may be " +
            "empty.")]
        private HapticMaskMap? mask;

        [SerializeField, Tooltip("The tip follows the heights of this relief on matching objects. It may be empty.")]
        private HapticRelief? relief;

        private HapticMaterialRule()
        {
        }

        /// <summary>The property of an object that the rule matches.</summary>
        public MaterialRuleSubject Subject => subject;

        /// <summary>For <see cref="MaterialRuleSubject.Tag"/>.</summary>
        public string Tag => tag ?? "";

        /// <summary>For <see cref="MaterialRuleSubject.Layer"/>, 0 to 31.</summary>
        public int Layer => layer;

        /// <summary>For <see cref="MaterialRuleSubject.PhysicsMaterial"/>.</summary>
        public SurfacePhysics? PhysicsMaterial => physicsMaterial;

        /// <summary>For <see cref="MaterialRuleSubject.RendererMaterial"/>.</summary>
        public Material? RendererMaterial => rendererMaterial;

        /// <summary>For <see cref="MaterialRuleSubject.TerrainLayer"/>.</summary>
        public TerrainLayer? TerrainLayer => terrainLayer;

        /// <summary>For <see cref="MaterialRuleSubject.Submesh"/>; null for every mesh.</summary>
        public Mesh? Mesh => mesh;

        /// <summary>For <see cref="MaterialRuleSubject.Submesh"/>, from 0.</summary>
        public int Submesh => submesh;

        /// <summary>For <see cref="MaterialRuleSubject.Name"/>.</summary>
        public string NamePattern => namePattern ?? "";

        /// <summary>The assigned material; null for none, so that the object is not felt.</summary>
        public HapticMaterial? Material { get => material; set => MaterialMaps.Set(ref material, value); }

        /// <summary>A texture that blends in further materials; null for none.</summary>
        public HapticMaskMap? Mask { get => mask; set => MaterialMaps.Set(ref mask, value); }

        /// <summary>The heights that the tip follows; null for none.</summary>
        public HapticRelief? Relief { get => relief; set => MaterialMaps.Set(ref relief, value); }

        /// <summary>A rule for a Unity tag.</summary>
        public static HapticMaterialRule ForTag(string tag, HapticMaterial? material) =>
            For(MaterialRuleSubject.Tag, material, rule => rule.tag = tag);

        /// <summary>A rule for a layer, 0 to 31.</summary>
        public static HapticMaterialRule ForLayer(int layer, HapticMaterial? material) =>
            For(MaterialRuleSubject.Layer, material, rule => rule.layer = layer);

        /// <summary>A rule for a physics material.</summary>
        public static HapticMaterialRule ForPhysicsMaterial(SurfacePhysics physicsMaterial, HapticMaterial? material) =>
            For(MaterialRuleSubject.PhysicsMaterial, material, rule => rule.physicsMaterial = physicsMaterial);

        /// <summary>A rule for a renderer's material.</summary>
        public static HapticMaterialRule ForRendererMaterial(Material rendererMaterial, HapticMaterial? material) =>
            For(MaterialRuleSubject.RendererMaterial, material, rule => rule.rendererMaterial = rendererMaterial);

        /// <summary>A rule for a terrain layer.</summary>
        public static HapticMaterialRule ForTerrainLayer(TerrainLayer terrainLayer, HapticMaterial? material) =>
            For(MaterialRuleSubject.TerrainLayer, material, rule => rule.terrainLayer = terrainLayer);

        /// <summary>A rule for a submesh.</summary>
        /// <param name="mesh">Null for every mesh.</param>
        /// <param name="submesh">From 0.</param>
        public static HapticMaterialRule ForSubmesh(Mesh? mesh, int submesh, HapticMaterial? material) =>
            For(MaterialRuleSubject.Submesh, material, rule => (rule.mesh, rule.submesh) = (mesh, submesh));

        /// <summary>A rule for object names.</summary>
        /// <param name="namePattern">A * stands for any characters; case is ignored.</param>
        public static HapticMaterialRule ForName(string namePattern, HapticMaterial? material) =>
            For(MaterialRuleSubject.Name, material, rule => rule.namePattern = namePattern);

        private static HapticMaterialRule For(
            MaterialRuleSubject subject, HapticMaterial? material, Action<HapticMaterialRule> set)
        {
            var rule = new HapticMaterialRule { subject = subject, material = material };
            set(rule);
            return rule;
        }

        /// <summary>Describes what the rule matches, for people: <c>tag "Floor"</c>. Makes garbage.</summary>
        public string Describe() => subject switch
        {
            MaterialRuleSubject.Tag => $"tag \"{Tag}\"",
            MaterialRuleSubject.Layer => LayerMask.LayerToName(layer) is { Length: > 0 } name
                ? $"layer \"{name}\"" : $"layer {layer}",
            MaterialRuleSubject.PhysicsMaterial => "physics material " + NameOf(physicsMaterial),
            MaterialRuleSubject.RendererMaterial => "renderer material " + NameOf(rendererMaterial),
            MaterialRuleSubject.TerrainLayer => "terrain layer " + NameOf(terrainLayer),
            MaterialRuleSubject.Submesh => $"submesh {submesh}" + (mesh != null ? $" of \"{mesh.name}\"" : ""),
            _ => $"name \"{NamePattern}\"",
        };

        /// <summary>False where the rule lacks the value to compare with; it then matches nothing.</summary>
        internal bool IsComplete => subject switch
        {
            MaterialRuleSubject.Tag => Tag.Length > 0,
            MaterialRuleSubject.Layer => layer >= 0 && layer < 32,
            MaterialRuleSubject.PhysicsMaterial => physicsMaterial != null,
            MaterialRuleSubject.RendererMaterial => rendererMaterial != null,
            MaterialRuleSubject.TerrainLayer => terrainLayer != null,
            MaterialRuleSubject.Submesh => submesh >= 0,
            _ => NamePattern.Length > 0,
        };

        /// <param name="part">A submesh or a terrain layer, from 0.</param>
        internal bool Matches(ColliderFacts facts, int part) => subject switch
        {
            MaterialRuleSubject.Tag => string.Equals(Tag, facts.Tag, StringComparison.Ordinal),
            MaterialRuleSubject.Layer => layer == facts.Layer,
            MaterialRuleSubject.PhysicsMaterial => ColliderFacts.IsSameOrCopy(physicsMaterial, facts.PhysicsMaterial),
            MaterialRuleSubject.RendererMaterial =>
                ColliderFacts.IsSameOrCopy(rendererMaterial, facts.RendererMaterialOf(part)),
            MaterialRuleSubject.TerrainLayer => terrainLayer != null && facts.TerrainLayerOf(part) == terrainLayer,
            MaterialRuleSubject.Submesh =>
                facts.Mesh != null && submesh == part && (mesh == null || mesh == facts.Mesh),
            _ => HaptoFlow.NamePattern.Matches(NamePattern, facts.Name),
        };

        private static string NameOf(UnityEngine.Object? asset) => asset != null ? $"\"{asset.name}\"" : "(none)";
    }
}
