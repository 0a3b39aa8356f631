#nullable enable
using System.Collections.Generic;
using UnityEngine;

namespace HaptoFlow
{
    /// <summary>Chooses the audio output of a stylus without one of its own. An enabled output of the scene's author
    /// takes precedence; a disabled one means silence. Where the scene has neither, a stylus plays on the device in its
    /// hand, if that vibrates (<see cref="AutoOutput"/>); otherwise an audio output is created, and removed when the
    /// author's appears. Main thread; no garbage while nothing changes.</summary>
    internal static class SceneOutputs
    {
        private static readonly List<HapticOutput> Authors = new List<HapticOutput>();
        private static HapticOutput? made;

        // An output disabled by its author: found by a search that makes garbage, and kept until it is destroyed.
        private static HapticOutput? dormant;
        private static bool hasSearched;

        /// <summary>True where the last request got no output because the author's outputs are disabled.</summary>
        public static bool AreSwitchedOff => Authors.Count == 0 && dormant != null;

        /// <summary>Null for silence.</summary>
        /// <param name="asker">The stylus, named in the message about an output that had to be created.</param>
        public static HapticOutput? For(HapticStylus asker)
        {
            FindDisabledOutputs();
            if (Authors.Count > 0 || dormant != null || asker.Voices.HasNamedDevices)
            {
                AutoOutput.Retire(asker);
                return Authors.Count > 0 ? Authors[0] : null;
            }
            if (AutoOutput.Serves(asker))
            {
                return null;
            }
            if (made != null)
            {
                return made.isActiveAndEnabled ? made : null;
            }
            return Make(asker);
        }

        /// <summary>Call it from Awake, which also runs for a disabled component on an active object.</summary>
        public static void OnOutputAwake(HapticOutput output)
        {
            if (!output.IsMade)
            {
                DropMade();
            }
        }

        public static void Add(HapticOutput output)
        {
            if (!output.IsMade && !Authors.Contains(output))
            {
                DropMade();
                Authors.Add(output);
            }
        }

        public static void Remove(HapticOutput output)
        {
            Authors.Remove(output);
            hasSearched = false;
        }

        private static void FindDisabledOutputs()
        {
            // Unity's comparison with null detects destroyed objects, which have to be searched for again.
            if ((made is not null && made == null) || (dormant is not null && dormant == null))
            {
                made = null;
                dormant = null;
                hasSearched = false;
            }
            if (Authors.Count == 0 && !hasSearched)
            {
                hasSearched = true;
                dormant = FindAuthors();
            }
        }

        private static HapticOutput? FindAuthors()
        {
            HapticOutput[] all = Object.FindObjectsByType<HapticOutput>(
                FindObjectsInactive.Include, FindObjectsSortMode.None);
            return System.Array.Find(all, output => !output.IsMade);
        }

        // The created output belongs to the scene that had none; the next scene starts over.
        private static HapticOutput Make(HapticStylus asker)
        {
            made = HapticOutput.Make();
            Debug.Log("HaptoFlow: the scene has no Haptic Output, so one was created that plays on every channel of " +
                "the audio device. Add one to choose a channel.", asker);
            return made;
        }

        private static void DropMade()
        {
            if (made != null)
            {
                Object.Destroy(made.gameObject);
            }
            made = null;
            hasSearched = false;
        }

        [RuntimeInitializeOnLoadMethod(RuntimeInitializeLoadType.SubsystemRegistration)]
        private static void Forget()
        {
            Authors.Clear();
            made = null;
            dormant = null;
            hasSearched = false;
        }
    }
}
