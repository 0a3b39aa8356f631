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
        /// <summary>Empty until one is chosen.</summary>
        [field: SerializeField]
        public string Label { get; set; } = "";

        /// <summary>Empty for none.</summary>
        [field: SerializeField]
        public string SecondLabel { get; set; } = "";

        /// <summary>0: the first label alone. 1: the second alone.</summary>
        [field: SerializeField]
        public float Share { get; set; } = 0.5f;

        public void Take(LabelMix mix)
        {
            Label = mix.First;
            SecondLabel = mix.Second;
            Share = mix.Second.Length > 0 ? mix.Share : 0.5f;
        }

        /// <summary>The label; where none is chosen, the one of that index among the model's.</summary>
        public string LabelOr(IReadOnlyList<string> labels, int index) =>
            Label.Length > 0 ? Label : index < labels.Count ? labels[index] : labels.Count > 0 ? labels[0] : "wood";

        public LabelMix Mix(IReadOnlyList<string> labels, int index) =>
            new LabelMix(LabelOr(labels, index), SecondLabel, SecondLabel.Length > 0 ? Share : 0f);
    }
}
