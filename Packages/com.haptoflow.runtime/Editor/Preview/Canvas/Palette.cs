#nullable enable

namespace HaptoFlow.Preview
{
    /// <summary>Colours of the pictures, one set for each skin of the editor.</summary>
    internal sealed class Palette
    {
        /// <summary>For the editor's dark skin.</summary>
        public static readonly Palette Dark = new Palette
        {
            Window = Colour.Of(0x383838),
            Card = Colour.Of(0x26282c),
            Plot = Colour.Of(0x1b1d20),
            Grid = Colour.Of(0x383c43),
            Ink = Colour.Of(0xeceae6),
            Soft = Colour.Of(0xa6acb6),
            First = Colour.Of(0x5fb4f5),
            Second = Colour.Of(0xffa34d),
            Speed = Colour.Of(0x63d0b2),
            Force = Colour.Of(0xee8fc7),
            Patch = Colour.Of(0x33373d),
        };

        /// <summary>For the editor's light skin.</summary>
        public static readonly Palette Light = new Palette
        {
            Window = Colour.Of(0xc8c8c8),
            Card = Colour.Of(0xf5f4f1),
            Plot = Colour.Of(0xffffff),
            Grid = Colour.Of(0xdedbd4),
            Ink = Colour.Of(0x1f2227),
            Soft = Colour.Of(0x565c66),
            First = Colour.Of(0x1a6bb0),
            Second = Colour.Of(0xb24b06),
            Speed = Colour.Of(0x0c7a66),
            Force = Colour.Of(0xa8357f),
            Patch = Colour.Of(0xe6e0d4),
        };

        private Palette()
        {
        }

        /// <summary>Of the editor's windows.</summary>
        public Colour Window { get; private set; }

        /// <summary>Behind a group of charts.</summary>
        public Colour Card { get; private set; }

        /// <summary>Behind curves.</summary>
        public Colour Plot { get; private set; }

        public Colour Grid { get; private set; }

        /// <summary>Text that matters.</summary>
        public Colour Ink { get; private set; }

        /// <summary>Scales and remarks.</summary>
        public Colour Soft { get; private set; }

        /// <summary>Of material A.</summary>
        public Colour First { get; private set; }

        /// <summary>Of material B.</summary>
        public Colour Second { get; private set; }

        public Colour Speed { get; private set; }

        public Colour Force { get; private set; }

        /// <summary>The surface that is stroked.</summary>
        public Colour Patch { get; private set; }
    }
}
