#nullable enable
using System;
using System.Collections.Generic;
using HaptoFlow.Preview;
using UnityEngine;

namespace HaptoFlow.Editor
{
    /// <summary>The settings of the Texture Preview window, with undo.</summary>
    internal sealed class TexturePreviewState : PreviewState<TexturePreviewState>
    {
        public const float MinimumSpeedMps = 0.002f;
        public const float MaximumSpeedMps = 2f;
        public const float MinimumForceNewtons = 0.05f;
        public const float MaximumForceNewtons = 5f;
        public const float MaximumSeconds = 8f;
        public const float MinimumLandingMps = 0.01f;
        public const float MaximumLandingMps = 2f;

        public MaterialChoice First = new MaterialChoice();
        public MaterialChoice Second = new MaterialChoice();
        public bool Compares = true;

        /// <summary>The heights under the stroke, for both materials; null for an even surface.</summary>
        public HapticRelief? Relief;

        /// <summary>Index of the material that is played and exported, if two are shown.</summary>
        public int Active;
        public StrokePreset Preset = StrokePreset.BackAndForth;
        public float SpeedMps = 0.12f;
        public float ForceNewtons = 1.5f;
        public float DirectionDegrees = 30f;
        public float ContactSeconds = 2.5f;
        public float LandingMps = 0.3f;
        public bool HasTexture = true;
        public bool HasImpact = true;
        public bool HasEdge = true;
        public PreviewDevice Device;

        /// <summary>The connected device that plays along with the speakers.</summary>
        public FeltDevice FeltOn;

        /// <summary>The kind of file that the button Export writes.</summary>
        public SoundFormat ExportAs;

        /// <summary>Points of the drawn stroke. Set a new array instead of changing elements.</summary>
        public DrawnPoint[] Drawn = Array.Empty<DrawnPoint>();

        /// <summary>Name of the tier; empty for the model's default.</summary>
        public string Tier = "";
        public int Seed = 1;

        /// <summary>True to play both sounds with the gain at which the louder one nearly reaches full scale.</summary>
        public bool Raises = true;
        public bool ShowsSliders;

        protected override string WindowName => "Texture Preview";

        /// <summary>True if a device's output is shown in place of the second material.</summary>
        public bool ShowsDevice => Device != PreviewDevice.Actuator;

        public bool ShowsSecond => Compares && !ShowsDevice;

        /// <summary>Index of the sound that is played, among those that are shown.</summary>
        public int PlayedIndex => Compares || ShowsDevice ? Active : 0;

        public StrokeSettings Settings =>
            new StrokeSettings(SpeedMps, ForceNewtons, DirectionDegrees, ContactSeconds, LandingMps);

        public HapticEffects Effects
        {
            get
            {
                HapticEffects effects = (HasTexture ? HapticEffects.Texture : 0) |
                    (HasImpact ? HapticEffects.Impact : 0) | (HasEdge ? HapticEffects.Edge : 0);
                return effects == HapticEffects.Unspecified ? HapticEffects.Nothing : effects;
            }
        }

        public MaterialChoice Material(int index) => index == 0 || ShowsDevice ? First : Second;

        public IReadOnlyList<LabelMix> Mixes(IReadOnlyList<string> labels)
        {
            LabelMix first = First.Mix(labels, 0);
            return ShowsSecond ? new[] { first, Second.Mix(labels, 1) } : new[] { first };
        }

        /// <summary>The one of <see cref="Mixes"/> that is played, directly or by the device.</summary>
        public LabelMix PlayedMix(IReadOnlyList<string> labels) => Mixes(labels)[ShowsDevice ? 0 : PlayedIndex];

        /// <summary>Replaces the active material. Can be undone.</summary>
        /// <param name="learnt">A learnt material that replaces the mix's first label; null for the label.</param>
        public void Take(LabelMix mix, HapticMaterial? learnt) =>
            Change("Material", changed => changed.Material(changed.PlayedIndex).Take(mix, learnt));

        /// <summary>Replaces the active material, and the relief by that of the object which the material was found on.
        /// Can be undone.</summary>
        public void Take(LabelMix mix, HapticMaterial? learnt, SelectedMaterial found) => Change("Material", changed =>
        {
            changed.Material(changed.PlayedIndex).Take(mix, learnt);
            changed.Relief = found.IsObject ? found.Relief : changed.Relief;
        });
    }

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

        public string Label = "";

        /// <summary>Label of the blend's second material; empty for none.</summary>
        public string SecondLabel = "";
        public float Share = 0.5f;

        /// <summary>Positions of the sliders; empty if all are 0. Set a new array, do not change elements.</summary>
        public float[] Moves = Array.Empty<float>();

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
