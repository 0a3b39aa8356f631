#nullable enable
using UnityEngine;

namespace HaptoFlow
{
    /// <summary>Makes a <see cref="HapticMaterialMap"/> count for the scene that this object is in, before the
    /// project's.</summary>
    [AddComponentMenu("HaptoFlow/Haptic Material Map Scope")]
    [HelpURL(HelpPages.Components + "haptic-material-map-scope")]
    public sealed class HapticMaterialMapScope : MonoBehaviour
    {
        [SerializeField, Tooltip("The map that counts for this scene.")]
        private HapticMaterialMap? map;

        [SerializeField, Tooltip("Of several in one scene, the lowest is asked first.")]
        private int order;

        /// <summary>The map that counts for the scene.</summary>
        public HapticMaterialMap? Map
        {
            get => map;
            set
            {
                map = value;
                MaterialMaps.Change();
            }
        }

        /// <summary>Of several in one scene, the lowest is asked first; equal ones in the order in which they were
        /// switched on.</summary>
        public int Order
        {
            get => order;
            set
            {
                order = value;
                MaterialMaps.Reorder();
            }
        }

        private void OnEnable()
        {
            MaterialMaps.Add(this);
            TerrainWeights.ReadScenes();
        }

        private void OnDisable() => MaterialMaps.Remove(this);

        private void OnValidate() => MaterialMaps.Reorder();
    }
}
