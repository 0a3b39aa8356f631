#nullable enable
using HaptoFlow.Contact;
using UnityEngine;

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

        [SerializeField, Tooltip("Where the wave goes; empty for the scene's output, or one that is made.")]
        private HapticOutput? output;

        [SerializeField, Range(0f, 1f)]
        private float strength = 1f;

        private TipContacts? contacts;
        private StylusVoice? voice;
        private bool touching;
        private HapticContact contact;

        /// <summary>The tip touched something. Main thread.</summary>
        public event HapticContactHandler? TouchBegan;

        /// <summary>The touch goes on; once an update. Main thread.</summary>
        public event HapticContactHandler? TouchMoved;

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

        /// <summary>Where the wave goes.</summary>
        public HapticOutput? Output
        {
            get => output;
            set => output = value;
        }

        /// <summary>Gain, 0 to 1, on top of the surface's and the output's.</summary>
        public float Strength
        {
            get => strength;
            set => strength = Mathf.Clamp01(value);
        }

        /// <summary>The tip touches a tagged surface.</summary>
        public bool IsTouching => touching;

        /// <summary>What is touched, or was last.</summary>
        public HapticContact Contact => contact;

        /// <summary>What had to be put right in the tip's samples.</summary>
        public ContactStatistics ContactStatistics => contacts?.Tracker.Statistics ?? default;

        /// <summary>False while the stylus has no voice: before the model is loaded, or without one.</summary>
        public bool TryGetStatistics(out VoiceStatistics statistics)
        {
            statistics = default;
            return voice != null && voice.TryGetStatistics(out statistics);
        }

        /// <summary>Silence at once; sounds again with the next touch-down.</summary>
        public void Panic() => voice?.Panic();

        /// <summary>The tip was carried elsewhere, by a teleport or a hand-over: what it touched and its speed are
        /// forgotten. Jumps faster than 20 m/s are noticed without this.</summary>
        public void ForgetMotion()
        {
            contacts?.Forget();
            EndTouch();
        }

        private void OnEnable()
        {
            contacts ??= new TipContacts(new ContactSettings(), tipRadiusMetres);
            contacts.Tracker.TipRadiusMetres = tipRadiusMetres;
            voice ??= new StylusVoice(this);
            HapticSession.Current.Poll();
        }

        private void OnDisable()
        {
            ForgetMotion();
            voice?.Close();
        }

        private void OnValidate() => TipRadiusMetres = tipRadiusMetres;

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
            ContactReading reading;
            using (Markers.Contact.Auto())
            {
                reading = contacts!.Update(SampleAt(nowSeconds), stepSeconds, layers, session, this);
            }
            TellOf(reading);
            using (Markers.Publish.Auto())
            {
                voice!.Publish(reading, contacts.Touched?.Surface, session);
            }
        }

        private TipSample SampleAt(double nowSeconds)
        {
            Transform place = tip != null ? tip : transform;
            double? measured = force != null && force.isActiveAndEnabled && force.TryRead(out float newtons)
                ? newtons
                : (double?)null;
            return new TipSample(nowSeconds, place.position.ToDouble(), measured);
        }

        private void TellOf(in ContactReading reading)
        {
            NearbySurface? touched = contacts!.Touched;
            if (touched == null)
            {
                EndTouch();
                return;
            }
            contact = new HapticContact(touched.Surface, touched.Collider!, reading);
            bool began = !touching;
            touching = true;
            if (began)
            {
                TouchBegan?.Invoke(this, contact);
            }
            else
            {
                TouchMoved?.Invoke(this, contact);
            }
        }

        private void EndTouch()
        {
            if (touching)
            {
                touching = false;
                TouchEnded?.Invoke(this, contact);
            }
        }
    }
}
