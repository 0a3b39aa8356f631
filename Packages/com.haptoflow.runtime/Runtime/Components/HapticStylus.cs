#nullable enable
using System.Collections.Generic;
using HaptoFlow.Contact;
using UnityEngine;
using UnityEngine.Events;

namespace HaptoFlow
{
    /// <summary>When a stylus samples its tip.</summary>
    public enum StylusUpdate
    {
        /// <summary>Once a rendered frame, after scripts have moved objects.</summary>
        RenderedFrames,

        /// <summary>At every physics step.</summary>
        FixedUpdates,
    }

    /// <summary>Tracks a tip, finds the surface it touches and plays that surface's vibration.</summary>
    [AddComponentMenu("HaptoFlow/Haptic Stylus")]
    [DefaultExecutionOrder(1000)]
    [HelpPage(HelpPages.Components + "haptic-stylus")]
    public sealed class HapticStylus : MonoBehaviour
    {
        private static readonly List<HapticStylus> EnabledStyluses = new List<HapticStylus>();

        [SerializeField, Tooltip("The tip is the centre of the sphere that touches. When it is empty, this object is " +
            "the tip.")]
        private Transform? tip;

        [SerializeField, Min(0f), Tooltip("The tip sphere has this radius, in metres of the hand, and contact begins " +
            "this far from a surface. A pen has 0.002.")]
        private float tipRadiusMetres = 0.002f;

        [SerializeField, Tooltip("The stylus feels colliders on these layers.")]
        private LayerMask layers = ~0;

        [SerializeField, Tooltip("The stylus reads its pose in rendered frames, which follow the hand best, or in " +
            "fixed updates, which suit tips that physics moves.")]
        private StylusUpdate update = StylusUpdate.RenderedFrames;

        [SerializeField, Tooltip("The component measures the tip force, in newtons. When it is empty, the spring " +
            "model f = k d gives the force.")]
        private TipForceSource? force;

        [SerializeField, Tooltip("With Geometry, a touch is the tip cutting into a surface. With Measured Force, the " +
            "tip force near a surface decides, for a real object under the virtual one.")]
        private TouchDecision touchBy = TouchDecision.Geometry;

        [SerializeField]
        private ForceDecision forceDecision = new ForceDecision();

        [SerializeField, Tooltip("The wave plays on this output. When it is empty, it plays on the device in the " +
            "hand, on the scene's output, or on one that play mode adds.")]
        private HapticOutput? output;

        [SerializeField, Tooltip("This hand holds the stylus. Outputs that vibrate in a hand need it, and the wave " +
            "plays on the device in this hand unless an output is named or has a channel of its own. With None, it is " +
            "the hand in which the tip force is measured. An XR Pen sets the field.")]
        private HapticHand hand = HapticHand.None;

        [SerializeField, Range(0f, 1f), Tooltip("Strength is a gain from 0 to 1, multiplied with those of surface " +
            "and output.")]
        private float strength = 1f;

        [SerializeField, Tooltip("The scale of this object says how many metres of the world a metre of the hand is, in " +
            "a doll house or for a giant. When it is empty, it is the object that carries the main camera and the pen, " +
            "or the root above the pen.")]
        private Transform? rig;

        [SerializeField]
        private HapticStylusEvents events = new HapticStylusEvents();

        private TipContacts? contacts;
        private StylusVoices? voices;
        private RigScale? rigScale;
        private bool isActive;
        private bool touching;
        private bool hasSaidHand;
        private int steppedFrame = -1;
        private Vector3 steppedPlace;
        private HapticContact contact;
        private HapticRelief? relief;
        private MapPlace reliefPlace;
        private HapticClip? playedClip;

        /// <summary>The tip touched a surface. Main thread.</summary>
        public event HapticContactHandler? TouchBegan;

        /// <summary>Raised once an update while the touch continues. Main thread.</summary>
        public event HapticContactHandler? TouchMoved;

        /// <summary>The tip slid from one surface to another, or between colliders with materials of a <see
        /// cref="HapticMaterialMap"/>, without lifting; the contact is the new one. Main thread.</summary>
        public event HapticContactHandler? SurfaceChanged;

        /// <summary>The touch ended; the contact is the last one. Main thread.</summary>
        public event HapticContactHandler? TouchEnded;

        /// <summary>Transform at the centre of the tip; null for this object.</summary>
        public Transform? Tip { get => tip; set => tip = value; }

        /// <summary>Radius of the tip sphere, in metres of the hand, 0 or more.</summary>
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

        /// <summary>Layers whose colliders the tip can touch.</summary>
        public LayerMask Layers { get => layers; set => layers = value; }

        /// <summary>When the stylus samples its tip.</summary>
        public StylusUpdate UpdateMode { get => update; set => update = value; }

        /// <summary>Source of the measured tip force; null for the spring model.</summary>
        public TipForceSource? Force { get => force; set => force = value; }

        /// <summary>What decides whether the tip touches.</summary>
        public TouchDecision TouchBy { get => touchBy; set => touchBy = value; }

        /// <summary>Thresholds of a measured force; used with <see cref="TouchDecision.MeasuredForce"/>.</summary>
        public ForceDecision ForceDecision => forceDecision;

        /// <summary>Events for wiring in the Inspector.</summary>
        public HapticStylusEvents Events => events;

        /// <summary>The audio output of the stylus; null for the scene's. Outputs that vibrate in a hand (<see
        /// cref="DeviceOutput"/>) reference their stylus instead, so one stylus can have several.</summary>
        public HapticOutput? Output { get => output; set => output = value; }

        /// <summary>The hand that holds the stylus, for outputs that vibrate in it: the one set here, else the one in
        /// which <see cref="Force"/> is (<see cref="TipForceSource.HeldIn"/>).</summary>
        public HapticHand Hand
        {
            get => hand != HapticHand.None || force == null ? hand : force.HeldIn;
            set => hand = value;
        }

        /// <summary>Gain, 0 to 1, multiplied with the surface's and the output's.</summary>
        public float Strength { get => strength; set => strength = Mathf.Clamp01(value); }

        /// <summary>The object whose scale is that of the hand's metre; null to find it, as the tooltip says. Velocity,
        /// depth and force are the hand's; surfaces and their features keep their size in the world.</summary>
        public Transform? Rig { get => rig; set => rig = value; }

        /// <summary>True while the tip touches a surface.</summary>
        public bool IsTouching => touching;

        /// <summary>The present touch, or the last one.</summary>
        public HapticContact Contact => contact;

        /// <summary>Corrections that the contact model made to the tip's samples.</summary>
        public ContactStatistics ContactStatistics => contacts?.Tracker.Statistics ?? default;

        /// <summary>False while the stylus has no voice: before the model is loaded, or without a free voice.</summary>
        public bool TryGetStatistics(out VoiceStatistics statistics)
        {
            HapticVoice? voice = voices?.Open;
            statistics = voice?.Statistics() ?? default;
            return voice != null;
        }

        /// <summary>Statistics of one effect of the stylus's voice. False while the stylus has no voice.</summary>
        public bool TryGetEffectStatistics(HapticEffect effect, out EffectStatistics statistics)
        {
            HapticVoice? voice = voices?.Open;
            statistics = voice?.EffectStatistics(effect) ?? default;
            return voice != null;
        }

        /// <summary>Delays of the onsets and ends of the signal of the stylus's output. False while the stylus has no
        /// voice.</summary>
        public bool TryGetSignalStatistics(out SignalStatistics statistics)
        {
            HapticVoice? voice = voices?.OnAudio;
            statistics = voice?.SignalStatistics() ?? default;
            return voice != null;
        }

        /// <summary>Silences the stylus at once; it sounds again with the next touch-down.</summary>
        public void Panic() => voices?.Panic();

        /// <summary>Plays a clip on every output of the stylus, beside the texture, whether or not the tip touches, in
        /// place of the clip that plays. Strengths and what acts on the voice act on it. It ends with mute, pause, panic,
        /// <see cref="Haptics.Restart"/> and a change of the output, and is not played while one of these silences the
        /// stylus. The first play of a clip takes about 1 ms for each second of it; later ones make no garbage. Main
        /// thread.</summary>
        /// <param name="clip">It may be destroyed while it plays.</param>
        /// <param name="gain">Limited to 0 to <see cref="HapticClipFile.MaximumGain"/>; NaN counts as 0.</param>
        /// <param name="loop">True to repeat it until another clip, or <see cref="StopClip()"/>.</param>
        /// <returns>False where nothing was begun and what plays goes on: the stylus has no voice, as while the engine
        /// loads; or the clip is null, destroyed or damaged, which the console says once.</returns>
        public bool Play(HapticClip? clip, float gain = 1f, bool loop = false)
        {
            HapticClipFile? content = clip != null ? clip.Content : null;
            if (content == null || voices == null || !voices.PlayClip(content, ClipGain(gain), loop))
            {
                return false;
            }
            playedClip = clip;
            return true;
        }

        /// <summary>Ends the clip that plays, within some milliseconds. Main thread.</summary>
        public void StopClip()
        {
            playedClip = null;
            voices?.PlayClip(null, 0f, false);
        }

        /// <summary>Discards the touch and the speed of a tip that was teleported or handed over. Jumps faster than 20
        /// m/s are detected without this call.</summary>
        public void ForgetMotion()
        {
            contacts?.Forget();
            EndTouch();
        }

        /// <summary>The relief under the tip as of the last update, and the place in its map; false without one.
        /// </summary>
        internal bool TryGetRelief(out HapticRelief felt, out MapPlace place)
        {
            (felt, place) = (relief!, reliefPlace);
            return touching && relief is object && relief != null;
        }

        internal static IReadOnlyList<HapticStylus> Enabled => EnabledStyluses;

        /// <summary>Ends the clip if it is the newest.</summary>
        internal void StopClip(HapticClip started)
        {
            if (ReferenceEquals(playedClip, started))
            {
                StopClip();
            }
        }

        internal static float ClipGain(float gain) => gain > 0f ? Mathf.Min(gain, HapticClipFile.MaximumGain) : 0f;

        internal Vector3 TipPosition => tip != null ? tip.position : transform.position;

        /// <summary>The name that people know: the pen's, for a stylus on the child Tip of a pen.</summary>
        internal string PenName => name == "Tip" && transform.parent != null ? transform.parent.name : name;

        internal StylusVoices Voices => voices ??= new StylusVoices(this);

        // Play mode without a domain reload keeps static fields, and objects may be gone without a message.
        [RuntimeInitializeOnLoadMethod(RuntimeInitializeLoadType.SubsystemRegistration)]
        private static void ForgetAll() => EnabledStyluses.Clear();

        private void OnEnable()
        {
            rigScale ??= new RigScale(this);
            contacts ??= new TipContacts(tipRadiusMetres, transform);
            contacts.Tracker.TipRadiusMetres = tipRadiusMetres;
            isActive = true;
            EnabledStyluses.Add(this);
            HapticSession.Current.Poll();
            MaterialMaps.Poll();
        }

        private void OnDisable()
        {
            isActive = false;
            EnabledStyluses.Remove(this);
            ForgetMotion();
            playedClip = null;
            voices?.Close();
        }

        private void OnValidate()
        {
            TipRadiusMetres = tipRadiusMetres;
            forceDecision.ResetDetector();
        }

        private void LateUpdate()
        {
            if (update == StylusUpdate.RenderedFrames)
            {
                double sinceStep = Time.timeAsDouble - Time.fixedTimeAsDouble;
                UpdateContact(Time.unscaledTimeAsDouble,
                    Time.timeScale > 0f ? sinceStep / Time.timeScale : double.NaN);
            }
        }

        private void FixedUpdate()
        {
            if (update != StylusUpdate.FixedUpdates)
            {
                return;
            }
            if (RepeatsItselfInThisFrame())
            {
                contacts!.Tracker.Pass(Time.fixedUnscaledTimeAsDouble);
            }
            else
            {
                UpdateContact(Time.fixedUnscaledTimeAsDouble, 0.0);
            }
        }

        /// <summary>True for a further step of the same rendered frame in which the tip has not moved. After a hitch
        /// physics makes many steps at once, and what follows a hand waits in all of them for the frame: no stop of the
        /// hand.</summary>
        private bool RepeatsItselfInThisFrame()
        {
            Vector3 place = TipPosition;
            bool repeats = steppedFrame == Time.frameCount && steppedPlace.Equals(place);
            steppedFrame = Time.frameCount;
            steppedPlace = place;
            return repeats;
        }

        private void UpdateContact(double nowSeconds, double secondsSinceStep)
        {
            HapticSession session = HapticSession.Current;
            session.Poll();
            MaterialMaps.Poll();
            contacts!.Scale = rigScale!.Update(!touching);
            contacts.Tracker.Force = touchBy == TouchDecision.MeasuredForce ? forceDecision.Detector() : null;
            ContactReading reading;
            using (Markers.Contact.Auto())
            {
                reading = contacts.Update(SampleAt(nowSeconds), secondsSinceStep, layers, session, this);
            }
            RaiseTouchEvents(reading, session);
            // A handler may have disabled the stylus; a voice opened now would never be closed.
            if (!isActive)
            {
                return;
            }
            using (Markers.Publish.Auto())
            {
                ReliefPlace.Write(contacts.Touched, ref reading);
                (relief, reliefPlace) = reading.State.Relief != 0
                    ? (contacts.Touched!.Felt.Relief, reading.State.ReliefPlace)
                    : (null, default);
                Voices.Publish(reading, contacts.Touched?.Felt.On(contacts.Scale) ?? default, session);
            }
        }

        private TipSample SampleAt(double nowSeconds)
        {
            double? measured = TryReadForce(out float newtons) ? newtons : (double?)null;
            return new TipSample(nowSeconds, TipPosition.ToDouble() / contacts!.Scale, measured);
        }

        private bool TryReadForce(out float newtons)
        {
            newtons = 0f;
            if (force == null || !force.isActiveAndEnabled)
            {
                return false;
            }
            bool has = touchBy == TouchDecision.MeasuredForce
                ? force.TryMeasure(out newtons)
                : force.TryRead(out newtons);
            if (has && newtons > 0f && !hasSaidHand && Hand == HapticHand.None)
            {
                SayHand();
            }
            return has;
        }

        private void SayHand()
        {
            hasSaidHand = true;
            Debug.Log($"HaptoFlow: {name} measures the force of its tip, but no hand is known to hold it, so no controller " +
                "or pen in a hand plays it. Choose the hand in its field Hand; a pen on a tablet needs none.", this);
        }

        private void RaiseTouchEvents(in ContactReading reading, HapticSession session)
        {
            NearbyCollider? touched = contacts!.Touched;
            if (touched == null)
            {
                EndTouch();
                return;
            }
            HapticContact before = contact;
            contact = new HapticContact(touched, touched.Felt, reading);
            if (!touching)
            {
                touching = true;
                TouchBegan?.Invoke(this, contact);
                Invoke(events.TouchBegan);
                ResolveAgain(session);
                return;
            }
            if (contact.IsElsewhere(before))
            {
                SurfaceChanged?.Invoke(this, contact);
                Invoke(events.SurfaceChanged);
                ResolveAgain(session);
            }
            if (touching)
            {
                TouchMoved?.Invoke(this, contact);
                Invoke(events.TouchMoved);
            }
        }

        /// <summary>A touch begins with the material that its own handlers gave the surface.</summary>
        private void ResolveAgain(HapticSession session) => contacts!.Touched?.Resolve(session);

        // A handler called before may have ended the touch.
        private void Invoke(UnityEvent<HapticSurface> handlers)
        {
            if (touching)
            {
                handlers.Invoke(contact.Surface!);
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
