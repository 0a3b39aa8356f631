#nullable enable
using HaptoFlow.Contact;
using UnityEngine;
using UnityEngine.Events;

namespace HaptoFlow
{
    /// <summary>When a stylus looks at its tip.</summary>
    public enum StylusUpdate
    {
        /// <summary>Once a rendered frame, after scripts have moved things.</summary>
        RenderedFrames,

        /// <summary>At every physics step.</summary>
        FixedUpdates,
    }

    /// <summary>Follows a tip, finds the surface it touches, and makes that surface felt.</summary>
    [AddComponentMenu("HaptoFlow/Haptic Stylus")]
    [DefaultExecutionOrder(1000)]
    [HelpURL(HelpPages.Components + "haptic-stylus")]
    public sealed class HapticStylus : MonoBehaviour
    {
        [SerializeField, Tooltip("Centre of the tip; empty for this object.")]
        private Transform? tip;

        [SerializeField, Min(0f), Tooltip("Of the tip sphere, in metres.")]
        private float tipRadiusMetres = 0.002f;

        [SerializeField, Tooltip("Layers whose colliders can be felt.")]
        private LayerMask layers = ~0;

        [SerializeField]
        private StylusUpdate update = StylusUpdate.RenderedFrames;

        [SerializeField, Tooltip("The stylus's own tip force; empty for the spring model f = k d.")]
        private TipForceSource? force;

        [SerializeField, Tooltip("What decides that the tip touches. Measured Force is for a real object under the " +
            "virtual one, and needs a tip force.")]
        private TouchDecision touchBy = TouchDecision.Geometry;

        [SerializeField]
        private ForceDecision forceDecision = new ForceDecision();

        [SerializeField, Tooltip("Where the wave goes; empty for the scene's output, or one that is made.")]
        private HapticOutput? output;

        [SerializeField, Tooltip("The hand that holds the stylus. Outputs that vibrate in a hand need it; an XR Pen " +
            "sets it.")]
        private HapticHand hand = HapticHand.None;

        [SerializeField, Range(0f, 1f)]
        private float strength = 1f;

        [SerializeField]
        private HapticStylusEvents events = new HapticStylusEvents();

        private TipContacts? contacts;
        private StylusVoices? voices;
        private bool following;
        private bool touching;
        private HapticContact contact;

        /// <summary>The tip touched something. Main thread.</summary>
        public event HapticContactHandler? TouchBegan;

        /// <summary>The touch goes on; once an update. Main thread.</summary>
        public event HapticContactHandler? TouchMoved;

        /// <summary>The tip slid from one surface to another, or between colliders that are felt by rules, without
        /// lifting; the contact is the new one. Main thread.</summary>
        public event HapticContactHandler? SurfaceChanged;

        /// <summary>The touch ended; the contact is the last one. Main thread.</summary>
        public event HapticContactHandler? TouchEnded;

        /// <summary>Centre of the tip; null for this object.</summary>
        public Transform? Tip
        {
            get => tip;
            set => tip = value;
        }

        /// <summary>Of the tip sphere, 0 or more.</summary>
        public float TipRadiusMetres
        {
            get => tipRadiusMetres;
            set
            {
                tipRadiusMetres = Mathf.Max(0f, value);
                if (contacts != null)
                {
                    contacts.Tracker.TipRadiusMetres = tipRadiusMetres;
                }
            }
        }

        /// <summary>Layers whose colliders can be felt.</summary>
        public LayerMask Layers
        {
            get => layers;
            set => layers = value;
        }

        /// <summary>When the stylus looks at its tip.</summary>
        public StylusUpdate UpdateMode
        {
            get => update;
            set => update = value;
        }

        /// <summary>Null for the spring model.</summary>
        public TipForceSource? Force
        {
            get => force;
            set => force = value;
        }

        /// <summary>What decides that the tip touches.</summary>
        public TouchDecision TouchBy
        {
            get => touchBy;
            set => touchBy = value;
        }

        /// <summary>When a measured force is a touch; counts with <see cref="TouchDecision.MeasuredForce"/>.</summary>
        public ForceDecision ForceDecision => forceDecision;

        /// <summary>The events for wiring in the Inspector.</summary>
        public HapticStylusEvents Events => events;

        /// <summary>The audio output where the wave goes; null for the scene's. Outputs that vibrate in a hand
        /// (<see cref="DeviceOutput"/>) name their stylus instead, so that one stylus may have several.</summary>
        public HapticOutput? Output
        {
            get => output;
            set => output = value;
        }

        /// <summary>The hand that holds the stylus, for outputs that vibrate in it.</summary>
        public HapticHand Hand
        {
            get => hand;
            set => hand = value;
        }

        /// <summary>Gain, 0 to 1, on top of the surface's and the output's.</summary>
        public float Strength
        {
            get => strength;
            set => strength = Mathf.Clamp01(value);
        }

        /// <summary>The tip touches something that can be felt.</summary>
        public bool IsTouching => touching;

        /// <summary>What is touched, or was last.</summary>
        public HapticContact Contact => contact;

        /// <summary>What had to be put right in the tip's samples.</summary>
        public ContactStatistics ContactStatistics => contacts?.Tracker.Statistics ?? default;

        /// <summary>False while the stylus has no voice: before the model is loaded, or without one.</summary>
        public bool TryGetStatistics(out VoiceStatistics statistics)
        {
            statistics = default;
            return voices != null && voices.TryGetStatistics(out statistics);
        }

        /// <summary>What one stage of the stylus's voice did. False while the stylus has no voice.</summary>
        public bool TryGetEffectStatistics(HapticEffect effect, out EffectStatistics statistics)
        {
            statistics = default;
            return voices != null && voices.TryGetEffectStatistics(effect, out statistics);
        }

        /// <summary>How late the signal of the stylus's output began and ended. False while the stylus has no voice.
        /// </summary>
        public bool TryGetSignalStatistics(out SignalStatistics statistics)
        {
            statistics = default;
            return voices != null && voices.TryGetSignalStatistics(out statistics);
        }

        /// <summary>Silence at once; sounds again with the next touch-down.</summary>
        public void Panic() => voices?.Panic();

        /// <summary>The tip was carried elsewhere, by a teleport or a hand-over: what it touched and its speed are
        /// forgotten. Jumps faster than 20 m/s are noticed without this.</summary>
        public void ForgetMotion()
        {
            contacts?.Forget();
            EndTouch();
        }

        /// <summary>Centre of the tip, in world space.</summary>
        internal Vector3 TipPosition => tip != null ? tip.position : transform.position;

        /// <summary>The voices of this stylus, one for each of its outputs.</summary>
        internal StylusVoices Voices => voices ??= new StylusVoices(this);

        private void OnEnable()
        {
            contacts ??= new TipContacts(new ContactSettings(), tipRadiusMetres, transform);
            contacts.Tracker.TipRadiusMetres = tipRadiusMetres;
            following = true;
            HapticSession.Current.Poll();
            MaterialMaps.Poll();
            TerrainWeights.ReadScenes();
        }

        private void OnDisable()
        {
            following = false;
            ForgetMotion();
            voices?.Close();
        }

        private void OnValidate()
        {
            TipRadiusMetres = tipRadiusMetres;
            forceDecision.Forget();
        }

        private void LateUpdate()
        {
            if (update == StylusUpdate.RenderedFrames)
            {
                double now = Time.unscaledTimeAsDouble;
                double sinceStep = Time.timeAsDouble - Time.fixedTimeAsDouble;
                Follow(now, Time.timeScale > 0f ? now - sinceStep / Time.timeScale : now);
            }
        }

        private void FixedUpdate()
        {
            if (update == StylusUpdate.FixedUpdates)
            {
                Follow(Time.fixedUnscaledTimeAsDouble, Time.fixedUnscaledTimeAsDouble);
            }
        }

        private void Follow(double nowSeconds, double stepSeconds)
        {
            HapticSession session = HapticSession.Current;
            session.Poll();
            MaterialMaps.Poll();
            contacts!.Tracker.Force = touchBy == TouchDecision.MeasuredForce ? forceDecision.Touch() : null;
            ContactReading reading;
            using (Markers.Contact.Auto())
            {
                reading = contacts.Update(SampleAt(nowSeconds), stepSeconds, layers, session, this);
            }
            TellOf(reading, session);
            // A handler may have switched the stylus off: then nobody would close a voice that opened now.
            if (!following)
            {
                return;
            }
            using (Markers.Publish.Auto())
            {
                // After the handlers, which may have changed what the surface is made of.
                Voices.Publish(reading, contacts.Touched?.Feel(session) ?? default, session);
            }
        }

        private TipSample SampleAt(double nowSeconds)
        {
            double? measured = TryReadForce(out float newtons) ? newtons : (double?)null;
            return new TipSample(nowSeconds, TipPosition.ToDouble(), measured);
        }

        private bool TryReadForce(out float newtons)
        {
            newtons = 0f;
            if (force == null || !force.isActiveAndEnabled)
            {
                return false;
            }
            return touchBy == TouchDecision.MeasuredForce
                ? force.TryMeasure(out newtons)
                : force.TryRead(out newtons);
        }

        private void TellOf(in ContactReading reading, HapticSession session)
        {
            NearbySurface? touched = contacts!.Touched;
            if (touched == null)
            {
                EndTouch();
                return;
            }
            HapticContact before = contact;
            contact = new HapticContact(touched, touched.Feel(session), reading);
            if (!touching)
            {
                touching = true;
                TouchBegan?.Invoke(this, contact);
                Invoke(events.TouchBegan);
                return;
            }
            if (contact.IsElsewhere(before))
            {
                SurfaceChanged?.Invoke(this, contact);
                Invoke(events.SurfaceChanged);
            }
            if (touching)
            {
                TouchMoved?.Invoke(this, contact);
                Invoke(events.TouchMoved);
            }
        }

        // A handler before this one may have ended the touch.
        private void Invoke(UnityEvent<HapticSurface> told)
        {
            if (touching)
            {
                told.Invoke(contact.Surface!);
            }
        }

        private void EndTouch()
        {
            if (touching)
            {
                touching = false;
                TouchEnded?.Invoke(this, contact);
                events.TouchEnded.Invoke(contact.Surface!);
            }
        }
    }
}
