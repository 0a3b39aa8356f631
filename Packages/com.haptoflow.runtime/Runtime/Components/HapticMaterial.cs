#nullable enable
using System;
using HaptoFlow.Model;
using UnityEngine;
using Object = UnityEngine.Object;

namespace HaptoFlow
{
    /// <summary>What a surface is made of, by the names of a model's labels: a retrained model does not shuffle scenes.
    /// </summary>
    [Serializable]
    public sealed class MaterialDescription
    {
        internal const float SmallestFeatureScale = 0.25f;
        internal const float LargestFeatureScale = 4f;
        internal const float MostToneDbPerOctave = 12f;

        [SerializeField, Tooltip("A label of the model.")]
        private string label = "wood";

        [SerializeField]
        [Tooltip("A Haptic Material that was learnt from a recording, in the place of the label; none for the label.")]
        private HapticMaterial? learnt;

        // The asset that this describes, where there is one.
        [NonSerialized]
        private HapticMaterial? owner;

        [SerializeField, Tooltip("A second label to blend with; empty for none.")]
        private string secondLabel = "";

        [SerializeField, Range(0f, 1f), Tooltip("0: the first label alone. 1: the second alone.")]
        private float blend;

        [SerializeField, Min(0f), Tooltip("Of the spring model, in N/m. 0: what the model says of the label.")]
        private float stiffnessNewtonsPerMetre;

        [SerializeField, Range(0f, 1f), Tooltip("Gain of the output while this is touched.")]
        private float strength = 1f;

        [SerializeField, Range(SmallestFeatureScale, LargestFeatureScale)]
        [Tooltip("The material's features, its ribs included, are this many times as large. 1 leaves them as they " +
            "are.")]
        private float featureScale = 1f;

        [SerializeField, Range(-MostToneDbPerOctave, MostToneDbPerOctave)]
        [Tooltip("The spectrum is tilted about 150 Hz by this many dB an octave: above 0 is brighter, below 0 darker.")]
        private float toneDbPerOctave;

        [SerializeField, Tooltip("The tip feels the material's texture while it slides.")]
        private bool texture = true;

        [SerializeField, Tooltip("The tip feels a landing, as hard as it was fast.")]
        private bool impact = true;

        [SerializeField, Tooltip("The tip feels rims, and the crossing to a rougher or smoother label.")]
        private bool edge = true;

        /// <summary>A label of the model, by name.</summary>
        public string Label
        {
            get => label;
            set => Change(ref label, value);
        }

        /// <summary>A Haptic Material that carries its embedding, felt in the place of <see cref="Label"/>; null for
        /// the label. The description of such an asset is made of the asset itself.</summary>
        public HapticMaterial? Learnt
        {
            get => owner != null && owner.IsLearnt ? owner : learnt != null && learnt.IsLearnt ? learnt : null;
            set
            {
                learnt = value;
                ++Version;
            }
        }

        /// <summary>Empty for none.</summary>
        public string SecondLabel
        {
            get => secondLabel;
            set => Change(ref secondLabel, value);
        }

        /// <summary>0: the first label alone. 1: the second alone.</summary>
        public float Blend
        {
            get => blend;
            set
            {
                blend = Mathf.Clamp01(value);
                ++Version;
            }
        }

        /// <summary>0: what the model says of the label.</summary>
        public float StiffnessNewtonsPerMetre
        {
            get => stiffnessNewtonsPerMetre;
            set
            {
                stiffnessNewtonsPerMetre = value;
                ++Version;
            }
        }

        /// <summary>0 to 1.</summary>
        public float Strength
        {
            get => strength;
            set => strength = Mathf.Clamp01(value);
        }

        /// <summary>How many times as large the material's features are, ribs included: 0.25 to 4. The level stays that
        /// of the tip's speed.</summary>
        public float FeatureScale
        {
            get => featureScale;
            set => featureScale = Mathf.Clamp(value, SmallestFeatureScale, LargestFeatureScale);
        }

        /// <summary>Tilt of the spectrum about 150 Hz, in dB an octave, -12 to 12: above 0 is brighter, below 0 darker.
        /// </summary>
        public float ToneDbPerOctave
        {
            get => toneDbPerOctave;
            set => toneDbPerOctave = Mathf.Clamp(value, -MostToneDbPerOctave, MostToneDbPerOctave);
        }

        /// <summary>Which effects this has: any of <see cref="HapticEffects.Texture"/>,
        /// <see cref="HapticEffects.Impact"/> and <see cref="HapticEffects.Edge"/>;
        /// <see cref="HapticEffects.Nothing"/> for none of them. An effect that no surface asks for costs
        /// nothing.</summary>
        public HapticEffects Effects
        {
            get
            {
                HapticEffects chosen = (texture ? HapticEffects.Texture : 0) | (impact ? HapticEffects.Impact : 0) |
                    (edge ? HapticEffects.Edge : 0);
                return chosen == HapticEffects.Unspecified ? HapticEffects.Nothing : chosen;
            }
            set
            {
                HapticEffects asked = value == HapticEffects.Unspecified ? HapticEffects.Texture : value;
                texture = (asked & HapticEffects.Texture) != 0;
                impact = (asked & HapticEffects.Impact) != 0;
                edge = (asked & HapticEffects.Edge) != 0;
            }
        }

        /// <summary>One more at each change that matters to whoever looked the labels up.</summary>
        internal int Version { get; private set; }

        internal void Touch() => ++Version;

        internal void BelongTo(HapticMaterial asset) => owner = asset;

        internal void CopyFrom(MaterialDescription other)
        {
            label = other.label;
            learnt = other.Learnt;
            secondLabel = other.secondLabel;
            blend = other.blend;
            stiffnessNewtonsPerMetre = other.stiffnessNewtonsPerMetre;
            strength = other.strength;
            featureScale = other.featureScale;
            toneDbPerOctave = other.toneDbPerOctave;
            texture = other.texture;
            impact = other.impact;
            edge = other.edge;
            ++Version;
        }

        private void Change(ref string field, string value)
        {
            field = value ?? "";
            ++Version;
        }
    }

    /// <summary>A material that several surfaces share: labels of the model, or one that was learnt from a recording
    /// and carries its embedding.</summary>
    [CreateAssetMenu(menuName = "HaptoFlow/Haptic Material", fileName = "HapticMaterial", order = 1)]
    [HelpURL(HelpPages.Components + "haptic-material")]
    public sealed class HapticMaterial : ScriptableObject
    {
        [SerializeField]
        private MaterialDescription description = new MaterialDescription();

        // The text of a .haptomaterial file, as the engine takes it.
        [SerializeField, HideInInspector]
        private string learnt = "";

        private readonly MaterialLookUp lookUp = new MaterialLookUp();

        /// <summary>What the surfaces that share this are made of.</summary>
        public MaterialDescription Description
        {
            get
            {
                description.BelongTo(this);
                return description;
            }
        }

        /// <summary>It was learnt from a recording, and is felt in the place of its description's label wherever the
        /// model is the one that it was learnt for.</summary>
        public bool IsLearnt => learnt.Length > 0;

        /// <summary>The text of its material file; empty where it is made of labels alone.</summary>
        public string Learnt => learnt;

        /// <summary>Makes a material of a material file's text. Main thread.</summary>
        /// <param name="text">Of a whole .haptomaterial file.</param>
        /// <param name="label">A label of the model, felt where the material cannot be: usually the nearest.</param>
        /// <exception cref="HaptoFlowException">The text is none; the message names the key.</exception>
        public static HapticMaterial Create(string text, string label)
        {
            string name = MaterialFile.Read(text).Name;
            var material = CreateInstance<HapticMaterial>();
            material.name = name;
            material.Description.Label = label;
            material.learnt = text;
            return material;
        }

        /// <summary>Carries another material from now on; where it is touched, that is felt as soon as the engine has
        /// it. Main thread.</summary>
        /// <param name="text">Of a whole .haptomaterial file; empty for the description's labels alone.</param>
        /// <exception cref="HaptoFlowException">The text is none; the message names the key.</exception>
        public void Carry(string text)
        {
            if (text.Length > 0)
            {
                MaterialFile.Read(text);
            }
            learnt = text;
            Announce();
        }

        /// <summary>The labels as the engine takes them, looked up again only when something changed.</summary>
        /// <param name="user">Who is named where the model does not know a label.</param>
        internal MaterialLookUp LookUp(HapticSession session, Object user) => lookUp.Of(Description, session, user);

        private void Announce()
        {
            description.Touch();
            HapticSession.TellOfChange(this);
        }

        private void OnEnable() => Announce();

        private void OnValidate() => Announce();

        private void OnDestroy() => HapticSession.TellOfEnd(this);
    }
}
