#nullable enable
using System;
using UnityEngine;

namespace HaptoFlow
{
    /// <summary>What a channel of a mask controls.</summary>
    public enum MaskChannelUse
    {
        /// <summary>The channel is ignored.</summary>
        Nothing = 0,

        /// <summary>The weight of a further material: full at white, none at black.</summary>
        Material = 1,

        /// <summary>A factor on the strength.</summary>
        Strength = 2,

        /// <summary>A factor on the feature scale.</summary>
        FeatureScale = 3,
    }

    /// <summary>One channel of a mask and what it controls.</summary>
    [Serializable]
    public sealed class MaskChannel
    {
        [SerializeField, Tooltip("The channel selects a material or scales a property.")]
        private MaskChannelUse use = MaskChannelUse.Nothing;

        [SerializeField, Tooltip("The material has more weight where the channel is brighter. When it is empty, that " +
            "share is not felt.")]
        private HapticMaterial? material;

        [SerializeField, Min(0f), Tooltip("At Black is the factor where the channel is black.")]
        private float lowest;

        [SerializeField, Min(0f), Tooltip("At White is the factor where the channel is white.")]
        private float highest = 1f;

        /// <summary>What the channel controls.</summary>
        public MaskChannelUse Use => use;

        /// <summary>The material of <see cref="MaskChannelUse.Material"/>; null for none.</summary>
        public HapticMaterial? Material => material;

        /// <summary>The factor where the channel is black.</summary>
        public float Lowest => lowest;

        /// <summary>The factor where the channel is white.</summary>
        public float Highest => highest;

        /// <summary>Makes the channel the weight of a material.</summary>
        public void SetMaterial(HapticMaterial? material)
        {
            use = MaskChannelUse.Material;
            this.material = material;
            MaterialMaps.Change();
        }

        /// <summary>Makes the channel a factor.</summary>
        /// <param name="use"><see cref="MaskChannelUse.Strength"/>, 0 to 1, or
        /// <see cref="MaskChannelUse.FeatureScale"/>, 0.25 to 4.</param>
        /// <param name="lowest">The factor where the channel is black.</param>
        /// <param name="highest">The factor where the channel is white.</param>
        public void SetFactor(MaskChannelUse use, float lowest, float highest)
        {
            this.use = use;
            this.lowest = lowest;
            this.highest = highest;
            MaterialMaps.Change();
        }

        internal float FactorAt(float value) => lowest + value * (highest - lowest);
    }

    /// <summary>A texture that selects materials over a surface. Baked in the editor from a readable texture; at run
    /// time only its compact copy is needed. Works on mesh colliders that are not convex and whose mesh is readable:
    /// only these have texture coordinates at the touched place.</summary>
    [CreateAssetMenu(menuName = "HaptoFlow/Haptic Mask Map", fileName = "HapticMaskMap", order = 4)]
    [HelpPage(HelpPages.Components + "haptic-mask-map")]
    public sealed class HapticMaskMap : ScriptableObject
    {
        internal const int Channels = 4;

        // In single precision a larger coordinate has no fraction left to locate a texel.
        private const float MaximumCoordinate = 1e6f;

        [SerializeField, Tooltip("The mask is baked from this texture, which has to be readable meanwhile. At run " +
            "time only the baked copy is used.")]
        private Texture2D? texture;

        [SerializeField, Tooltip("The longer side of the baked mask has at most this many texels. A larger texture " +
            "is halved until it fits.")]
        private int largestSize = 512;

        [SerializeField, Tooltip("When it is on, the mask lies over the second texture coordinates of the mesh, else " +
            "over the first.")]
        private bool secondCoordinates;

        [SerializeField, Tooltip("The texture repeats this often over the texture coordinates.")]
        private Vector2 tiling = new Vector2(1f, 1f);

        [SerializeField, Tooltip("The texture is shifted by this much over the texture coordinates.")]
        private Vector2 offset;

        [SerializeField]
        private MaskChannel red = new MaskChannel();

        [SerializeField]
        private MaskChannel green = new MaskChannel();

        [SerializeField]
        private MaskChannel blue = new MaskChannel();

        [SerializeField]
        private MaskChannel alpha = new MaskChannel();

        [SerializeField, HideInInspector]
        private byte[] texels = Array.Empty<byte>();

        [SerializeField, HideInInspector]
        private int width;

        [SerializeField, HideInInspector]
        private int height;

        [SerializeField, HideInInspector]
        private bool repeats = true;

        [SerializeField, HideInInspector]
        private string bakedContents = "";

        /// <summary>The texture that the channels are baked from, in the editor.</summary>
        public Texture2D? Texture { get => texture; set => texture = value; }

        /// <summary>Upper limit of the longer side of the baked copy, in texels.</summary>
        public int MaximumSize => Math.Max(1, largestSize);

        /// <summary>True to use the mesh's second texture coordinates instead of the first.</summary>
        public bool SecondCoordinates { get => secondCoordinates; set => secondCoordinates = value; }

        /// <summary>Number of repetitions of the texture over the texture coordinates.</summary>
        public Vector2 Tiling { get => tiling; set => tiling = value; }

        /// <summary>Shift of the texture over the texture coordinates.</summary>
        public Vector2 Offset { get => offset; set => offset = value; }

        /// <summary>What the red channel controls.</summary>
        public MaskChannel Red => red;

        /// <summary>What the green channel controls.</summary>
        public MaskChannel Green => green;

        /// <summary>What the blue channel controls.</summary>
        public MaskChannel Blue => blue;

        /// <summary>What the alpha channel controls.</summary>
        public MaskChannel Alpha => alpha;

        /// <summary>True after the texture was baked.</summary>
        public bool IsBaked => width > 0 && height > 0 && texels.Length == Channels * width * height;

        /// <summary>Width of the baked copy, in texels.</summary>
        public int Width => width;

        /// <summary>Height of the baked copy, in texels.</summary>
        public int Height => height;

        /// <summary>The editor's hash of the texture's contents at the time of baking.</summary>
        internal string BakedContents { get => bakedContents; set => bakedContents = value; }

        internal bool NamesMaterials
        {
            get
            {
                bool names = false;
                for (int index = 0; index < Channels; ++index)
                {
                    names |= ChannelAt(index).Use == MaskChannelUse.Material && ChannelAt(index).Material != null;
                }
                return names;
            }
        }

        /// <summary>Sets the texels: used by baking in the editor, and for textures created at run time. Main
        /// thread.</summary>
        /// <param name="width">Width in texels, 1 or more.</param>
        /// <param name="height">Height in texels, 1 or more.</param>
        /// <param name="pixels">Row by row from the bottom, as Texture2D.GetPixels32 returns them.</param>
        /// <param name="repeats">True to repeat the texture beyond the coordinates 0 to 1, false to extend its
        /// edge.</param>
        /// <exception cref="ArgumentException">The number of pixels does not match the size.</exception>
        public void SetPixels(int width, int height, Color32[] pixels, bool repeats)
        {
            if (width < 1 || height < 1 || pixels.Length != width * height)
            {
                throw new ArgumentException(
                    $"a mask of {width} x {height} texels needs {width * height} pixels, but {pixels.Length} were " +
                        $"given");
            }
            this.width = width;
            this.height = height;
            this.repeats = repeats;
            texels = new byte[Channels * pixels.Length];
            for (int index = 0; index < pixels.Length; ++index)
            {
                texels[Channels * index] = pixels[index].r;
                texels[Channels * index + 1] = pixels[index].g;
                texels[Channels * index + 2] = pixels[index].b;
                texels[Channels * index + 3] = pixels[index].a;
            }
            MaterialMaps.Change();
        }

        /// <summary>Blends the mask's materials over another at a place. No garbage.</summary>
        /// <param name="under">The material where no channel has one.</param>
        /// <returns>False where the mask does not apply: it is not baked, or the place has no texture
        /// coordinate.</returns>
        internal bool TryFeel(
            in TouchedPlace place, in ResolvedMaterial under, HapticSession session, UnityEngine.Object user,
            out ResolvedMaterial felt)
        {
            felt = default;
            if (!IsBaked || !place.TryGetTextureCoordinate(secondCoordinates, out Vector2 coordinate))
            {
                return false;
            }
            var sample = new Sample(this, coordinate);
            float covered = 0f;
            for (int index = 0; index < Channels; ++index)
            {
                covered += ChannelAt(index).Use == MaskChannelUse.Material ? sample[index] : 0f;
            }
            MaterialMix mix = MaterialMix.Shared;
            mix.Begin();
            mix.Add(under, Math.Max(0f, 1f - covered), 0);
            for (int index = 0; index < Channels; ++index)
            {
                MaskChannel channel = ChannelAt(index);
                if (channel.Use == MaskChannelUse.Material)
                {
                    mix.Add(channel.Material, session, user, sample[index], 0);
                }
            }
            felt = mix.Finish();
            felt.Strength = Limited(felt.Strength * Factor(MaskChannelUse.Strength, sample), 0f, 1f);
            felt.FeatureScale = Limited(felt.FeatureScale * Factor(MaskChannelUse.FeatureScale, sample),
                MaterialDescription.MinimumFeatureScale, MaterialDescription.MaximumFeatureScale);
            return true;
        }

        /// <summary>Returns 1 for NaN.</summary>
        private static float Limited(float value, float lowest, float highest) =>
            float.IsNaN(value) ? 1f : Mathf.Clamp(value, lowest, highest);

        private MaskChannel ChannelAt(int index) => index == 0 ? red : index == 1 ? green : index == 2 ? blue : alpha;

        private float Factor(MaskChannelUse use, in Sample sample)
        {
            float factor = 1f;
            for (int index = 0; index < Channels; ++index)
            {
                factor *= ChannelAt(index).Use == use ? ChannelAt(index).FactorAt(sample[index]) : 1f;
            }
            return factor;
        }

        private void OnValidate() => MaterialMaps.Change();

        /// <summary>The channels interpolated between four texels, 0 to 1.</summary>
        private readonly struct Sample
        {
            private readonly byte[] texels;
            private readonly (int Low, int High) left;
            private readonly (int Low, int High) right;
            private readonly float rightShare;
            private readonly float highShare;

            public Sample(HapticMaskMap map, Vector2 coordinate)
            {
                texels = map.texels;
                Place(coordinate.x * map.tiling.x + map.offset.x, map.width, map.repeats,
                    out int first, out int second, out rightShare);
                Place(coordinate.y * map.tiling.y + map.offset.y, map.height, map.repeats,
                    out int low, out int high, out highShare);
                left = (low * map.width + first, high * map.width + first);
                right = (low * map.width + second, high * map.width + second);
            }

            public float this[int channel]
            {
                get
                {
                    float low = Between(left.Low, right.Low, channel);
                    float high = Between(left.High, right.High, channel);
                    return (low + highShare * (high - low)) / byte.MaxValue;
                }
            }

            private float Between(int left, int right, int channel)
            {
                float first = texels[Channels * left + channel];
                float second = texels[Channels * right + channel];
                return first + rightShare * (second - first);
            }

            private static void Place(
                float coordinate, int size, bool repeats, out int first, out int second, out float share)
            {
                float inside = Mathf.Clamp(coordinate, -MaximumCoordinate, MaximumCoordinate);
                inside = repeats ? inside - (float)Math.Floor(inside) : Mathf.Clamp01(inside);
                inside = inside >= 0f ? inside : 0f;
                float texel = inside * size - 0.5f;
                int below = (int)Math.Floor(texel);
                share = texel - below;
                first = repeats ? (below + size) % size : Math.Max(0, below);
                second = repeats ? (below + 1) % size : Math.Min(size - 1, below + 1);
            }
        }
    }
}
