#nullable enable
using System;
using System.Collections.Generic;
using HaptoFlow.Preview;
using UnityEngine;

namespace HaptoFlow.Editor
{
    /// <summary>A material as it was chosen in the window.</summary>
    [Serializable]
    internal sealed class MaterialChoice
    {
        [SerializeField]
        private HapticMaterial? learnt;

        [SerializeField]
        private float featureScale = 1f;

        [SerializeField]
        private float toneDbPerOctave;

        /// <summary>Empty until one is chosen.</summary>
        [field: SerializeField]
        public string Label { get; set; } = "";

        /// <summary>Empty for none.</summary>
        [field: SerializeField]
        public string SecondLabel { get; set; } = "";

        /// <summary>0: the first label alone. 1: the second alone.</summary>
        [field: SerializeField]
        public float Share { get; set; } = 0.5f;

        /// <summary>Where the sliders are that move the material. Not to be changed: set another array.</summary>
        [field: SerializeField]
        public float[] Moves { get; set; } = Array.Empty<float>();

        /// <summary>How many times as large the features are, 0.25 to 4; anything else is limited to that.</summary>
        public float FeatureScale
        {
            get => featureScale;
            set => featureScale = Mathf.Clamp(
                value, MaterialDescription.SmallestFeatureScale, MaterialDescription.LargestFeatureScale);
        }

        /// <summary>Tilt of the spectrum about 150 Hz, -12 to 12; anything else is limited to that.</summary>
        public float ToneDbPerOctave
        {
            get => toneDbPerOctave;
            set => toneDbPerOctave = Mathf.Clamp(
                value, -MaterialDescription.MostToneDbPerOctave, MaterialDescription.MostToneDbPerOctave);
        }

        /// <summary>No slider changes the material.</summary>
        public bool IsAtRest => SliderSet.IsAtRest(Moves) && featureScale.Equals(1f) && toneDbPerOctave.Equals(0f);

        /// <summary>A material that was learnt, in the place of the label; null for the label.</summary>
        public HapticMaterial? Learnt
        {
            get => learnt != null && learnt.IsLearnt ? learnt : null;
            set => learnt = value;
        }

        /// <summary>Another label, or another learnt material: no slider moves it; scale and tone are the mix's.
        /// </summary>
        public void Take(LabelMix mix, HapticMaterial? material)
        {
            Label = mix.First;
            SecondLabel = mix.Second;
            Share = mix.Second.Length > 0 ? mix.Share : 0.5f;
            Learnt = material;
            Rest();
            FeatureScale = mix.FeatureScale;
            ToneDbPerOctave = mix.ToneDbPerOctave;
        }

        /// <summary>A label of the model; the sliders are at rest.</summary>
        public void Choose(string label)
        {
            Label = label;
            Learnt = null;
            Rest();
        }

        /// <summary>No slider changes the material any more.</summary>
        public void Rest()
        {
            Moves = Array.Empty<float>();
            FeatureScale = 1f;
            ToneDbPerOctave = 0f;
        }

        /// <summary>The label; where none is chosen, the one of that index among the model's.</summary>
        public string LabelOr(IReadOnlyList<string> labels, int index) =>
            Label.Length > 0 ? Label : index < labels.Count ? labels[index] : labels.Count > 0 ? labels[0] : "wood";

        /// <summary>The label or the learnt material, for people.</summary>
        public string NameOr(IReadOnlyList<string> labels, int index) =>
            Learnt != null ? Learnt.name : LabelOr(labels, index);

        public LabelMix Mix(IReadOnlyList<string> labels, int index) => new LabelMix(NameOr(labels, index), SecondLabel,
            SecondLabel.Length > 0 ? Share : 0f, Learnt != null ? Learnt.Learnt : "", Moves, FeatureScale,
            ToneDbPerOctave);
    }
}
