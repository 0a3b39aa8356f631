#nullable enable

namespace HaptoFlow.Preview
{
    /// <summary>A buffer of opaque colours. Immutable by convention: a texture made from it stays valid.</summary>
    internal sealed record ColourImage(int Width, int Height)
    {
        public const int BytesPerPixel = 4;

        /// <summary>Red, green, blue and opacity of each pixel. The lowest row is first, as in textures.</summary>
        public byte[] Pixels { get; } = new byte[Width * Height * BytesPerPixel];

        /// <param name="y">0 is the lowest row.</param>
        public void Set(int x, int y, Colour colour)
        {
            int index = (y * Width + x) * BytesPerPixel;
            Pixels[index] = colour.Red;
            Pixels[index + 1] = colour.Green;
            Pixels[index + 2] = colour.Blue;
            Pixels[index + 3] = colour.Opacity;
        }
    }
}
