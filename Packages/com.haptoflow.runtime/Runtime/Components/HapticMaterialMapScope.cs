#nullable enable
using UnityEngine;

namespace HaptoFlow
{
    /// <summary>Applies a <see cref="HapticMaterialMap"/> to the scene of this object, before the project's
    /// map.</summary>
    [AddComponentMenu("HaptoFlow/Haptic Material Map Scope")]
    [HelpPage(HelpPages.Components + "haptic-material-map-scope")]
    public sealed class HapticMaterialMapScope : MonoBehaviour
    {
        [SerializeField, Tooltip("The map that applies to this scene.")]
        private HapticMaterialMap? map;

        [SerializeField, Tooltip("The order among several maps of a scene. The lowest is tried first.")]
        private int order;

        /// <summary>The map of this scene.</summary>
        public HapticMaterialMap? Map { get => map; set => MaterialMaps.Set(ref map, value); }

        /// <summary>Order among several maps of a scene: the lowest is tried first; equal ones in the order in which
        /// they were enabled.</summary>
        public int Order
        {
            get => order;
            set
            {
                order = value;
                MaterialMaps.Reorder();
            }
        }

        private void OnEnable() => MaterialMaps.Add(this);

        private void OnDisable() => MaterialMaps.Remove(this);

        private void OnValidate() => MaterialMaps.Reorder();
    }
}
