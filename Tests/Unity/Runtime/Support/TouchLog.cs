#nullable enable
namespace HaptoFlow.Tests
{
    /// <summary>Counts a stylus's events and keeps the last contacts.</summary>
    internal sealed class TouchLog
    {
        public TouchLog(HapticStylus stylus)
        {
            stylus.TouchBegan += (HapticStylus _, in HapticContact contact) =>
            {
                ++Began;
                Last = contact;
            };
            stylus.TouchMoved += (HapticStylus _, in HapticContact contact) =>
            {
                ++Moved;
                Last = contact;
            };
            stylus.TouchEnded += (HapticStylus _, in HapticContact contact) => ++Ended;
        }

        public int Began { get; private set; }

        public int Moved { get; private set; }

        public int Ended { get; private set; }

        public HapticContact Last { get; private set; }
    }
}
