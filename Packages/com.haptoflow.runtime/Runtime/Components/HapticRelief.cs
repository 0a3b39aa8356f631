#nullable enable
using System;
using UnityEngine;

namespace HaptoFlow
{
    /// <summary>Heights of a surface that a tip follows, beside the texture of its material. Baked in the editor from
    /// the height or normal map of a material, a terrain's layer or a sculpted mesh, or set by a script. Felt on box
    /// colliders, terrains, and mesh colliders that are not convex and whose mesh is readable.</summary>
    /// <remarks>On a mesh the heights lie over the texture coordinates; on a face of a box, and on a terrain, they are
    /// laid out in metres of the world. The native library has a copy from the first touch on, until the asset is
    /// disabled. Main thread.</remarks>
    [CreateAssetMenu(menuName = "HaptoFlow/Haptic Relief", fileName = "HapticRelief", order = 5)]
    [HelpPage(HelpPages.Components + "haptic-relief")]
    public sealed class HapticRelief : ScriptableObject
    {
        internal const float MinimumDepthMillimetres = 0.01f;
        internal const float MaximumDepthMillimetres = 20f;
        private const float MinimumSizeMetres = 0.001f;

        [SerializeField, Tooltip("The size is the length of the map along its columns and its rows, in metres of the " +
            "world.")]
        private Vector2 sizeMetres = new Vector2(0.1f, 0.1f);

        [SerializeField, Range(MinimumDepthMillimetres, MaximumDepthMillimetres), Tooltip("The depth is the distance " +
            "between the lowest and the highest possible height, in millimetres.")]
        private float depthMillimetres = 1f;

        [SerializeField, Range(0f, 5f), Tooltip("The radius of the tip decides which grooves it reaches into, in " +
            "millimetres. A pen has 0.5.")]
        private float tipRadiusMillimetres = 0.5f;

        [SerializeField, Tooltip("When it is on, the map repeats beyond its rims, else the heights at the rims go on.")]
        private bool repeats = true;

        [SerializeField, Range(0f, 1f), Tooltip("How much of the device's range the relief may take beside the " +
            "texture.")]
        private float share = 0.5f;

        [SerializeField, Tooltip("The map repeats this often over the texture coordinates of a mesh.")]
        private Vector2 tiling = new Vector2(1f, 1f);

        [SerializeField, Tooltip("The map is shifted by this much over the texture coordinates of a mesh; over a " +
            "terrain, by this share of its size.")]
        private Vector2 offset;

        [SerializeField, HideInInspector]
        private ushort[] heights = Array.Empty<ushort>();

        [SerializeField, HideInInspector]
        private int columns;

        [SerializeField, HideInInspector]
        private int rows;

        [NonSerialized]
        private ReliefHeights? present;

        [NonSerialized]
        private HapticReliefMap? map;

        [NonSerialized]
        private bool isRefused;

        /// <summary>Length of the map along its columns and its rows, 0.001 m or more.</summary>
        public Vector2 SizeMetres
        {
            get => new Vector2(Mathf.Max(MinimumSizeMetres, sizeMetres.x), Mathf.Max(MinimumSizeMetres, sizeMetres.y));
            set => Change(ref sizeMetres, value);
        }

        /// <summary>Distance from the lowest to the highest possible height, 0.01 to 20 mm.</summary>
        public float DepthMillimetres
        {
            get => depthMillimetres;
            set => Change(ref depthMillimetres, Mathf.Clamp(value, MinimumDepthMillimetres, MaximumDepthMillimetres));
        }

        /// <summary>Radius of the tip's ball, 0 to 5 mm: it does not reach the bottom of a groove that is
        /// narrower.</summary>
        public float TipRadiusMillimetres
        {
            get => tipRadiusMillimetres;
            set => Change(ref tipRadiusMillimetres, Mathf.Clamp(value, 0f, 5f));
        }

        /// <summary>True to repeat the map beyond its rims, false to let the heights at the rims go on.</summary>
        public bool Repeats { get => repeats; set => Change(ref repeats, value); }

        /// <summary>How much of the device's range the relief may take beside the texture, 0 to 1.</summary>
        public float Share { get => share; set => share = Mathf.Clamp01(value); }

        /// <summary>Number of repetitions of the map over the texture coordinates of a mesh.</summary>
        public Vector2 Tiling { get => tiling; set => tiling = value; }

        /// <summary>Shift of the map over the texture coordinates of a mesh, and over a terrain, in lengths of the
        /// map.</summary>
        public Vector2 Offset { get => offset; set => offset = value; }

        /// <summary>True after heights were set.</summary>
        public bool IsBaked => columns > 0 && rows > 0 && heights.Length == columns * rows;

        /// <summary>Texels of a row; 0 without heights.</summary>
        public int Columns => columns;

        /// <summary>Rows of texels; 0 without heights.</summary>
        public int Rows => rows;

        /// <summary>The height of a texel, 0 to 1 of the depth.</summary>
        internal float HeightAt(int column, int row) => heights[row * columns + column] / (float)ushort.MaxValue;

        /// <summary>The heights as they are now, the same object until something changes; null where there are
        /// none.</summary>
        internal ReliefHeights? Heights
        {
            get
            {
                if (present == null && IsBaked)
                {
                    Vector2 size = SizeMetres;
                    present = new ReliefHeights(heights, columns)
                    {
                        SizeMetres = (size.x, size.y),
                        DepthMetres = 0.001f * depthMillimetres,
                        TipRadiusMetres = 0.001f * tipRadiusMillimetres,
                        IsTiled = repeats,
                    };
                }
                return present;
            }
        }

        /// <summary>The native library's number of the relief, which is made on first use; 0 where there are no
        /// heights, and where the library refused them.</summary>
        internal uint Number
        {
            get
            {
                if (map == null && !isRefused && IsBaked)
                {
                    Make();
                }
                return map?.Number ?? 0;
            }
        }

        /// <summary>Sets the heights: used by baking in the editor, and for reliefs made at run time. Main
        /// thread.</summary>
        /// <param name="columns">Texels of a row, 1 or more; with the rows, 3 145 728 texels at most.</param>
        /// <param name="rows">Rows of texels, 1 or more.</param>
        /// <param name="shares">Heights as shares of the depth, 0 to 1, row by row from the bottom, as
        /// Texture2D.GetPixels returns them.</param>
        /// <exception cref="ArgumentException">There are too many texels, or their number does not match the
        /// size.</exception>
        public void SetHeights(int columns, int rows, float[] shares)
        {
            if (columns < 1 || rows < 1 || (long)columns * rows > HapticReliefMap.MaximumTexels)
            {
                throw new ArgumentException($"a relief has 1 to {HapticReliefMap.MaximumTexels} texels, not " +
                    $"{columns} x {rows}: halve a larger map until it fits");
            }
            if (shares.Length != columns * rows)
            {
                throw new ArgumentException($"a relief of {columns} x {rows} texels needs {columns * rows} heights, " +
                    $"but {shares.Length} were given");
            }
            this.columns = columns;
            this.rows = rows;
            // A share that is not a number is 0.
            heights = Array.ConvertAll(
                shares, share => (ushort)((share > 0f ? Mathf.Min(1f, share) : 0f) * ushort.MaxValue + 0.5f));
            Release();
        }

        private void Make()
        {
            try
            {
                map = Heights!.MakeMap();
            }
            catch (HaptoFlowException refusal)
            {
                isRefused = true;
                Debug.LogWarning($"HaptoFlow: the relief {name} is not felt: {refusal.Message}", this);
            }
        }

        private void Change<T>(ref T field, T value)
        {
            field = value;
            Release();
        }

        private void Release()
        {
            map?.Dispose();
            map = null;
            present = null;
            isRefused = false;
        }

        private void OnValidate() => Release();

        private void OnDisable() => Release();
    }
}
