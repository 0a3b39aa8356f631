using System;
using UnityShim;

namespace HaptoFlow.EditorTests
{
    /// <summary>Frames of play mode with an engine that has no worker: it generates once a frame.</summary>
    internal static class SteppedFrames
    {
        /// <param name="count">The number of frames.</param>
        /// <param name="move">Called before each frame with its number.</param>
        public static void Play(int count, Action<int> move)
        {
            for (int frame = 0; frame < count; ++frame)
            {
                move(frame);
                World.Frame();
                HapticSession.Current.Engine!.Step();
            }
        }
    }
}
