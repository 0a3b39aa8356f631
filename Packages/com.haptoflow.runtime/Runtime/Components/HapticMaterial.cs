#nullable enable
using System;
using HaptoFlow.Model;
using UnityEngine;
using Object = UnityEngine.Object;

namespace HaptoFlow
{
    /// <summary>What a surface is made of. Labels are stored by name, so a retrained model with another order of labels
    /// does not change scenes.</summary>
    [Serializable]
    public sealed class MaterialDescription
    {
        internal const float MinimumFeatureScale = 0.25f;
        internal const float MaximumFeatureScale = 4f;
        internal const float MaximumToneDbPerOctave = 12f;

        [SerializeField, Tooltip("The label of the model names the material. It is saved by its name. A learnt " +
            "material takes its place, except until the engine has that material, and with another model.")]
        private string label = "wood";

        [SerializeField, Tooltip("The learnt material is a Haptic Material learnt from a recording. It replaces the " +
            "label. It may be empty.")]
        private HapticMaterial? learnt;

        // The asset that contains this description; null for a surface's own.
        [NonSerialized]
        private HapticMaterial? owner;

        [SerializeField, Tooltip("The second label is blended with the first. It may be empty.")]
        private string secondLabel = "";

        [SerializeField, Range(0f, 1f), Tooltip("The blend is 0 for the first label alone and 1 for the second label " +
            "alone.")]
        private float blend;

        [SerializeField, Min(0f), Tooltip("The stiffness of the spring model is the force per metre of penetration " +
            "depth. 0 takes the model's value for the label.")]
        private float stiffnessNewtonsPerMetre;

        [SerializeField, Range(0f, 1f), Tooltip("Strength is the gain of the output while this material is touched, " +
            "from 0 to 1.")]
        private float strength = 1f;

        [SerializeField, Range(MinimumFeatureScale, MaximumFeatureScale), Tooltip("The features of the material, its " +
            "ribs included, are larger by this factor, 0.25 to 4. The level does not change.")]
        private float featureScale = 1f;

        [SerializeField, Range(-MaximumToneDbPerOctave, MaximumToneDbPerOctave), Tooltip("The tone tilts the " +
            "spectrum about 150 Hz, by -12 to 12 dB per octave. Above 0 is brighter, below 0 darker.")]
        private float toneDbPerOctave;

        [SerializeField, Tooltip("The tip feels the material's texture while it slides.")]
        private bool texture = true;

        [SerializeField, Tooltip("The tip feels an impact at touch-down, stronger the faster it arrives.")]
        private bool impact = true;

        [SerializeField, Tooltip("The tip feels edges, and the transition to a rougher or smoother label.")]
        private bool edge = true;

        /// <summary>Name of a label of the model.</summary>
        public string Label { get => label; set => Change(ref label, value ?? ""); }

        /// <summary>A Haptic Material with an embedding of its own, used instead of <see cref="Label"/>; null for the
        /// label. For the description inside such an asset this is the asset itself.</summary>
        public HapticMaterial? Learnt
        {
            get => owner != null && owner.IsLearnt ? owner : learnt != null && learnt.IsLearnt ? learnt : null;
            set => Change(ref learnt, value);
        }

        /// <summary>True where the asset that contains this description, or its learnt material, was destroyed: nobody
        /// knows what it was like.</summary>
        internal bool IsUnloaded => HapticMaterial.IsUnloaded(owner) || HapticMaterial.IsUnloaded(learnt);

        /// <summary>Name of a second label to blend with; empty for none.</summary>
        public string SecondLabel { get => secondLabel; set => Change(ref secondLabel, value ?? ""); }

        /// <summary>Weight of the second label: 0 for the first label alone, 1 for the second alone.</summary>
        public float Blend { get => blend; set => Change(ref blend, Mathf.Clamp01(value)); }

        /// <summary>Stiffness of the spring model, in N/m; 0 for the model's value of the label.</summary>
        public float StiffnessNewtonsPerMetre
        {
            get => stiffnessNewtonsPerMetre;
            set => Change(ref stiffnessNewtonsPerMetre, value);
        }

        /// <summary>Gain of the output while this material is touched, 0 to 1.</summary>
        public float Strength { get => strength; set => strength = Mathf.Clamp01(value); }

        /// <summary>Feature scale: factor on the size of the material's features, ribs included, 0.25 to 4. The level
        /// stays that of the tip's speed.</summary>
        public float FeatureScale
        {
            get => featureScale;
            set => featureScale = Mathf.Clamp(value, MinimumFeatureScale, MaximumFeatureScale);
        }

        /// <summary>Tilt of the spectrum about 150 Hz, in dB per octave, -12 to 12; positive is brighter, negative
        /// darker.</summary>
        public float ToneDbPerOctave
        {
            get => toneDbPerOctave;
            set => toneDbPerOctave = Mathf.Clamp(value, -MaximumToneDbPerOctave, MaximumToneDbPerOctave);
        }

        /// <summary>The effects of this material: any of <see cref="HapticEffects.Texture"/>, <see
        /// cref="HapticEffects.Impact"/> and <see cref="HapticEffects.Edge"/>, or <see cref="HapticEffects.Nothing"/>.
        /// An effect that no surface has costs nothing.</summary>
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
                HapticEffects effects = value == HapticEffects.Unspecified ? HapticEffects.Texture : value;
                texture = (effects & HapticEffects.Texture) != 0;
                impact = (effects & HapticEffects.Impact) != 0;
                edge = (effects & HapticEffects.Edge) != 0;
            }
        }

        /// <summary>Increases with each change that invalidates a cached <see cref="MaterialLookUp"/>.</summary>
        internal int Version { get; private set; }

        internal void MarkChanged() => ++Version;

        internal void SetOwner(HapticMaterial asset) => owner = asset;

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

        private void Change<T>(ref T field, T value)
        {
            field = value;
            ++Version;
        }
    }

    /// <summary>A material that several surfaces share: made of labels of the model, or learnt from a recording and
    /// carrying its own embedding.</summary>
    [CreateAssetMenu(menuName = "HaptoFlow/Haptic Material", fileName = "HapticMaterial", order = 1)]
    [HelpPage(HelpPages.Components + "haptic-material")]
    public sealed class HapticMaterial : ScriptableObject
    {
        [SerializeField]
        private MaterialDescription description = new MaterialDescription();

        // The text of a .haptomaterial file, as the engine reads it.
        [SerializeField, HideInInspector]
        private string learnt = "";

        private readonly MaterialLookUp lookUp = new MaterialLookUp();

        /// <summary>What the surfaces that share this material are made of.</summary>
        public MaterialDescription Description
        {
            get
            {
                description.SetOwner(this);
                return description;
            }
        }

        /// <summary>True for a material learnt from a recording. It is used instead of its description's label wherever
        /// the model has the space that it was learnt for.</summary>
        public bool IsLearnt => learnt.Length > 0;

        /// <summary>The text of its material file; empty for a material made of labels alone.</summary>
        public string Learnt => learnt;

        /// <summary>Creates a material from the text of a material file. Main thread.</summary>
        /// <param name="text">The whole .haptomaterial file.</param>
        /// <param name="label">The label used where the material cannot be: usually the nearest.</param>
        /// <exception cref="HaptoFlowException">The text is not a material file; the message names the key.</exception>
        public static HapticMaterial Create(string text, string label) =>
            CreateUnchecked(text, MaterialFile.Read(text).Name, label);

        /// <summary>As <see cref="Create"/>, for an editor without the native library: engines check the text when they
        /// register it.</summary>
        internal static HapticMaterial CreateUnchecked(string text, string name, string label)
        {
            var material = CreateInstance<HapticMaterial>();
            material.name = name;
            material.Description.Label = label;
            material.learnt = text;
            return material;
        }

        /// <summary>Replaces the learnt material; where it is touched, the change is felt as soon as the engine has
        /// registered it. Main thread.</summary>
        /// <param name="text">The whole .haptomaterial file; empty for the description's labels alone.</param>
        /// <exception cref="HaptoFlowException">The text is not a material file; the message names the key.</exception>
        public void Carry(string text)
        {
            if (text.Length > 0)
            {
                MaterialFile.Read(text);
            }
            learnt = text;
            Announce();
        }

        /// <summary>True for a reference to a material that was destroyed. In the editor, an empty field of a component
        /// is no null reference either; it has no instance.</summary>
        internal static bool IsUnloaded(HapticMaterial? material) =>
            material is object && material.GetInstanceID() != 0 && material == null;

        /// <summary>The labels and their weights for the engine, looked up again only after a change.</summary>
        /// <param name="user">Object that a warning about an unknown label names.</param>
        internal MaterialLookUp LookUp(HapticSession session, Object user) => lookUp.Of(Description, session, user);

        private void Announce()
        {
            description.MarkChanged();
            HapticSession.OnMaterialChanged(this, !IsLearnt);
        }

        private void OnEnable() => Announce();

        private void OnValidate() => Announce();

        private void OnDestroy() => HapticSession.OnMaterialChanged(this, true);
    }
}
