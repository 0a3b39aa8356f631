#nullable enable
using System;
using System.Collections.Generic;
using UnityEngine;

namespace HaptoFlow.Samples.ClipSet
{
    /// <summary>Plays an exported set of clips for what a stylus touches: for platforms on which the native library or
    /// ONNX Runtime does not run. It needs neither.</summary>
    [AddComponentMenu("HaptoFlow/Samples/Clip Set Player")]
    [DefaultExecutionOrder(1100)]
    public sealed class ClipSetPlayer : MonoBehaviour
    {
        private const float FadeSeconds = 0.02f;

        [SerializeField, Tooltip("The file index.json of the set.")]
        private TextAsset? index;

        [SerializeField, Tooltip("The WAV files of the set, in any order.")]
        private AudioClip[] clips = Array.Empty<AudioClip>();

        [SerializeField, Tooltip("The set plays for this stylus. When it is empty, for the one on this object or above " +
            "it, or the scene's first.")]
        private HapticStylus? stylus;

        [SerializeField, Range(0f, 1f), Tooltip("Strength is a gain from 0 to 1.")]
        private float strength = 1f;

        [SerializeField, Range(-1f, 1f), Tooltip("The channel of a stereo device: -1 is the left one alone, 1 the right " +
            "one, 0 both.")]
        private float pan = 0f;

        [SerializeField, Tooltip("When it is on, the set plays only where HaptoFlow itself cannot: while Haptics.Problem " +
            "is not null.")]
        private bool onlyWithoutEngine = true;

        private readonly System.Random places = new System.Random(1);

        // Null for a label of which the set has no clips.
        private readonly Dictionary<string, AudioSource?[,]?> sources = new Dictionary<string, AudioSource?[,]?>();
        private ClipSetIndex? set;
        private GameObject? owner;

        /// <summary>Takes a set that was loaded while the scene runs.</summary>
        public void Use(TextAsset index, AudioClip[] clips)
        {
            (this.index, this.clips) = (index, clips);
            if (isActiveAndEnabled)
            {
                End();
                Begin();
            }
        }

        private void OnEnable()
        {
            if (stylus == null)
            {
                stylus = GetComponentInParent<HapticStylus>(false);
            }
            if (stylus == null)
            {
                HapticStylus[] all = FindObjectsByType<HapticStylus>(
                    FindObjectsInactive.Exclude, FindObjectsSortMode.None);
                stylus = all.Length > 0 ? all[0] : null;
            }
            Begin();
        }

        private void OnDisable() => End();

        private void Begin()
        {
            try
            {
                set = index != null ? new ClipSetIndex(index.text) : null;
            }
            catch (FormatException problem)
            {
                Debug.LogError($"{name}: {index!.name} is not the index of a clip set: {problem.Message}", this);
            }
            owner = new GameObject("Clip Set Sources");
            owner.transform.SetParent(transform, false);
        }

        private void End()
        {
            set = null;
            sources.Clear();
            if (owner != null)
            {
                Destroy(owner);
            }
        }

        private void LateUpdate()
        {
            if (set == null)
            {
                return;
            }
            bool plays = stylus != null && stylus.IsTouching && (!onlyWithoutEngine || Haptics.Problem != null);
            HapticContact contact = plays ? stylus!.Contact : default;
            string label = plays ? LabelOf(contact) : "";
            AudioSource?[,]? touched = label.Length > 0 ? SourcesOf(label) : null;
            var speeds = new ClipBlend(set.Speeds, plays ? contact.TangentialVelocity.magnitude : 0.0);
            var forces = new ClipBlend(set.Forces, plays ? contact.ForceNewtons : 0.0);
            float step = Time.unscaledDeltaTime / FadeSeconds;
            foreach (KeyValuePair<string, AudioSource?[,]?> each in sources)
            {
                for (int speed = 0; speed < set.Speeds.Length; ++speed)
                {
                    for (int force = 0; force < set.Forces.Length; ++force)
                    {
                        AudioSource? source = each.Value?[speed, force];
                        if (source != null)
                        {
                            Fade(source, ReferenceEquals(each.Value, touched)
                                ? strength * ClipBlend.Gain(speeds, speed, forces, force)
                                : 0f, step);
                        }
                    }
                }
            }
        }

        private void Fade(AudioSource source, float wanted, float step)
        {
            source.volume = source.volume < wanted
                ? Mathf.Min(wanted, source.volume + step)
                : Mathf.Max(wanted, source.volume - step);
            if (source.volume > 0f && !source.isPlaying)
            {
                // Loops that began together would beat against each other.
                source.timeSamples = places.Next(source.clip!.samples);
                source.Play();
            }
            else if (source.volume <= 0f && source.isPlaying)
            {
                source.Stop();
            }
        }

        private static string LabelOf(in HapticContact contact) => contact.Surface != null
            ? contact.Surface.SharedDescription.Label
            : contact.Material?.Label ?? "";

        private AudioSource?[,]? SourcesOf(string label)
        {
            if (sources.TryGetValue(label, out AudioSource?[,]? made))
            {
                return made;
            }
            if (!set!.Has(label))
            {
                Debug.LogWarning($"{name}: the set has no clips of {label}, which is not felt", this);
                sources[label] = null;
                return null;
            }
            made = new AudioSource?[set.Speeds.Length, set.Forces.Length];
            for (int speed = 0; speed < set.Speeds.Length; ++speed)
            {
                for (int force = 0; force < set.Forces.Length; ++force)
                {
                    made[speed, force] = SourceOf(set.NameOf(label, speed, force));
                }
            }
            sources[label] = made;
            return made;
        }

        private AudioSource? SourceOf(string? clipName)
        {
            AudioClip? clip = Array.Find(clips, each => each != null && each.name == clipName);
            if (clip == null)
            {
                Debug.LogWarning($"{name}: {clipName} of the set is not among the clips", this);
                return null;
            }
            AudioSource source = owner!.AddComponent<AudioSource>();
            source.clip = clip;
            source.loop = true;
            source.playOnAwake = false;
            source.volume = 0f;
            source.panStereo = pan;
            source.spatialBlend = 0f;
            source.bypassEffects = true;
            source.bypassListenerEffects = true;
            source.bypassReverbZones = true;
            return source;
        }
    }
}
