#nullable enable
using System;
using System.Collections.Generic;
using HaptoFlow.Preview;
using UnityEngine;

namespace HaptoFlow.Editor
{
    /// <summary>A material chosen in the Texture Preview window.</summary>
    [Serializable]
    internal sealed class MaterialChoice
    {
        [SerializeField]
        private HapticMaterial? learnt;

        [SerializeField]
        private float featureScale = 1f;

        [SerializeField]
        private float toneDbPerOctave;

        /// <summary>Empty until a label is chosen.</summary>
        [field: SerializeField]
        public string Label { get; set; } = "";

        /// <summary>Label of the blend's second material; empty for none.</summary>
        [field: SerializeField]
        public string SecondLabel { get; set; } = "";

        /// <summary>Share of the second label in the blend, 0 to 1.</summary>
        [field: SerializeField]
        public float Share { get; set; } = 0.5f;

        /// <summary>Positions of the sliders; empty if all are 0. Set a new array, do not change elements.</summary>
        [field: SerializeField]
        public float[] Moves { get; set; } = Array.Empty<float>();

        /// <summary>Feature scale, limited to 0.25 to 4.</summary>
        public float FeatureScale
        {
            get => featureScale;
            set => featureScale = Mathf.Clamp(
                value, MaterialDescription.MinimumFeatureScale, MaterialDescription.MaximumFeatureScale);
        }

        /// <summary>Tone: tilt of the spectrum about 150 Hz, limited to -12 to 12.</summary>
        public float ToneDbPerOctave
        {
            get => toneDbPerOctave;
            set => toneDbPerOctave = Mathf.Clamp(
                value, -MaterialDescription.MaximumToneDbPerOctave, MaterialDescription.MaximumToneDbPerOctave);
        }

        /// <summary>True if every slider has its default, feature scale and tone included.</summary>
        public bool IsAtRest => SliderSet.IsAtRest(Moves) && featureScale.Equals(1f) && toneDbPerOctave.Equals(0f);

        /// <summary>A learnt material that replaces the label; null for the label.</summary>
        public HapticMaterial? Learnt
        {
            get => learnt != null && learnt.IsLearnt ? learnt : null;
            set => learnt = value;
        }

        /// <summary>Chooses the material of a mix, its feature scale and tone; resets the other sliders.</summary>
        public void Take(LabelMix mix, HapticMaterial? material)
        {
            Label = mix.First;
            SecondLabel = mix.Second;
            Share = mix.Second.Length > 0 ? mix.Share : 0.5f;
            Learnt = material;
            ResetSliders();
            FeatureScale = mix.FeatureScale;
            ToneDbPerOctave = mix.ToneDbPerOctave;
        }

        /// <summary>Chooses a label of the model, and resets the sliders.</summary>
        public void Choose(string label)
        {
            Label = label;
            Learnt = null;
            ResetSliders();
        }

        /// <summary>Resets every slider.</summary>
        public void ResetSliders()
        {
            Moves = Array.Empty<float>();
            FeatureScale = 1f;
            ToneDbPerOctave = 0f;
        }

        /// <summary>The chosen label, or the model's label of an index if none is chosen.</summary>
        public string LabelOr(IReadOnlyList<string> labels, int index) =>
            Label.Length > 0 ? Label : index < labels.Count ? labels[index] : labels.Count > 0 ? labels[0] : "wood";

        /// <summary>Name of the learnt material or of the label, for display.</summary>
        public string NameOr(IReadOnlyList<string> labels, int index) =>
            Learnt != null ? Learnt.name : LabelOr(labels, index);

        public LabelMix Mix(IReadOnlyList<string> labels, int index) => new LabelMix(NameOr(labels, index), SecondLabel,
            SecondLabel.Length > 0 ? Share : 0f, Learnt != null ? Learnt.Learnt : "", Moves, FeatureScale,
            ToneDbPerOctave);
    }
}
