#nullable enable
using UnityEngine;

namespace HaptoFlow
{
    /// <summary>The audio source of an output that lies beside an Audio Listener: on a child object, where a filter
    /// reaches the source and not the listener.</summary>
    [AddComponentMenu("")]
    internal sealed class OutputSource : MonoBehaviour
    {
        private volatile HapticOutput? output;

        /// <summary>The source of an output; created at the first call. Main thread.</summary>
        public static AudioSource Of(HapticOutput output)
        {
            OutputSource? before = output.GetComponentInChildren<OutputSource>(true);
            if (before != null)
            {
                return before.GetComponent<AudioSource>();
            }
            var owner = new GameObject("HaptoFlow Source");
            owner.SetActive(false);
            owner.transform.SetParent(output.transform, false);
            var source = owner.AddComponent<AudioSource>();
            owner.AddComponent<OutputSource>();
            owner.SetActive(true);
            return source;
        }

        // Also after a recompilation while playing.
        private void OnEnable() => output = transform.parent!.GetComponent<HapticOutput>();

        // Audio thread: no garbage, no locks.
        private void OnAudioFilterRead(float[] data, int channels) => output?.Render(data, channels);
    }
}
