#nullable enable

namespace HaptoFlow.Preview
{
    /// <summary>The colours of the charts, one palette for each skin of the editor.</summary>
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

        /// <summary>Background of the editor's windows.</summary>
        public Colour Window { get; private set; }

        /// <summary>Background of a group of charts.</summary>
        public Colour Card { get; private set; }

        /// <summary>Background of a plot area.</summary>
        public Colour Plot { get; private set; }

        public Colour Grid { get; private set; }

        /// <summary>Primary text.</summary>
        public Colour Ink { get; private set; }

        /// <summary>Secondary text: axis numbers and remarks.</summary>
        public Colour Soft { get; private set; }

        /// <summary>Curves of material A.</summary>
        public Colour First { get; private set; }

        /// <summary>Curves of material B.</summary>
        public Colour Second { get; private set; }

        public Colour Speed { get; private set; }

        public Colour Force { get; private set; }

        /// <summary>Background of the patch on which strokes are drawn.</summary>
        public Colour Patch { get; private set; }
    }
}
