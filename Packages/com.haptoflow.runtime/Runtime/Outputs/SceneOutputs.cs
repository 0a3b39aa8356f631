#nullable enable
using System.Collections.Generic;
using UnityEngine;

namespace HaptoFlow
{
    /// <summary>Chooses the audio output of a stylus that names none. An output with a channel of its own takes every
    /// stylus. One on all channels is for loudspeakers: it takes the styluses that are not played by the device in
    /// their hand (<see cref="AutoOutput"/>). A disabled output means silence for those that it would take. Where the
    /// scene has no output, one is created, and removed when the author's appears. Main thread; no garbage while
    /// nothing changes.</summary>
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
        public static HapticOutput? For(HapticStylus asker)
        {
            FindDisabledOutputs();
            HapticOutput? enabled = Preferred(Authors);
            HapticOutput? authors = Authors.Count > 0 ? enabled : dormant;
            bool isTaken = authors is not null && authors.HasOwnChannel;
            if (asker.Voices.HasNamedDevices || isTaken)
            {
                AutoOutput.Retire(asker);
                if (enabled is not null && !asker.Voices.HasNamedDevices)
                {
                    SayThatTheHandIsLeftOut(asker, enabled);
                }
                return enabled;
            }
            if (AutoOutput.Serves(asker, authors))
            {
                return null;
            }
            if (authors is not null)
            {
                return enabled;
            }
            if (made != null)
            {
                return made.isActiveAndEnabled ? made : null;
            }
            return Make(asker);
        }

        /// <summary>The output that plays styluses which name none: the first with a channel of its own, else the
        /// first; null without any.</summary>
        public static HapticOutput? Preferred(IReadOnlyList<HapticOutput> outputs)
        {
            for (int index = 0; index < outputs.Count; ++index)
            {
                if (outputs[index].HasOwnChannel)
                {
                    return outputs[index];
                }
            }
            return outputs.Count > 0 ? outputs[0] : null;
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

        // Also finds the created output again after a recompilation, which empties static fields.
        private static HapticOutput? FindAuthors()
        {
            HapticOutput[] all = Object.FindObjectsByType<HapticOutput>(
                FindObjectsInactive.Include, FindObjectsSortMode.None);
            made = System.Array.Find(all, output => output.IsMade);
            return Preferred(System.Array.FindAll(all, output => !output.IsMade));
        }

        private static void SayThatTheHandIsLeftOut(HapticStylus asker, HapticOutput output)
        {
            if (asker.Hand != HapticHand.None && !ReferenceEquals(asker.Voices.LeftOutFor, output))
            {
                asker.Voices.LeftOutFor = output;
                Debug.Log($"HaptoFlow: {asker.PenName} plays on {output.name} and not through the device in its " +
                    $"{asker.Hand.InWords()} hand, because that output has a channel of its own. Add an Auto Output to the stylus to feel it " +
                    "there too.", asker);
            }
        }

        // The created output belongs to the scene that had none; the next scene starts over.
        private static HapticOutput? Make(HapticStylus asker)
        {
            UnityAudio.Poll();
            if (UnityAudio.Problem != null)
            {
                UnityAudio.SayProblem(asker.PenName, asker);
                return null;
            }
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
