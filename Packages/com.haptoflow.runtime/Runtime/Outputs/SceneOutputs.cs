#nullable enable
using System.Collections.Generic;
using UnityEngine;

namespace HaptoFlow
{
    /// <summary>Which audio output a stylus without one of its own plays on. An author's enabled output always wins; an
    /// author's disabled one means silence; where the scene has neither, a stylus plays on what its hand holds, if that
    /// can be felt (<see cref="AutoOutput"/>), else an audio output is made, and it goes when an author's appears. Main
    /// thread; no garbage while nothing changes.</summary>
    internal static class SceneOutputs
    {
        private static readonly List<HapticOutput> Authors = new List<HapticOutput>();
        private static HapticOutput? made;

        // Switched off by its author: found by a search that makes garbage, and kept until it is gone.
        private static HapticOutput? dormant;
        private static bool hasSearched;

        /// <summary>A stylus that asked got none, since the author's are switched off.</summary>
        public static bool AreSwitchedOff => Authors.Count == 0 && dormant != null;

        /// <summary>Null for silence.</summary>
        /// <param name="asker">Named in the message about an output that had to be made.</param>
        public static HapticOutput? For(HapticStylus asker)
        {
            FindWhatIsSwitchedOff();
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

        /// <summary>Also called for a disabled component, once its object is active.</summary>
        public static void Woke(HapticOutput output)
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

        private static void FindWhatIsSwitchedOff()
        {
            // Comparing with null asks Unity: what was destroyed has to be looked for again.
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

        // It belongs to the scene that had none: the next scene is asked anew.
        private static HapticOutput Make(HapticStylus asker)
        {
            made = HapticOutput.Make();
            Debug.Log("HaptoFlow: the scene has no Haptic Output, so one was made that plays on every channel of the " +
                "audio device. Add one to choose a channel.", asker);
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
