#nullable enable
using UnityEngine;

namespace HaptoFlow.Tests
{
    /// <summary>A constant signal on every channel, in place of other sources.</summary>
    internal sealed class SteadySource : MonoBehaviour
    {
        private void OnAudioFilterRead(float[] data, int channels)
        {
            for (int index = 0; index < data.Length; ++index)
            {
                data[index] = 0.25f;
            }
        }
    }
}
