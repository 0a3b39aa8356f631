#nullable enable
using System;
using System.Collections.Generic;
using HaptoFlow.Preview;
using UnityEditor;
using UnityEngine;

namespace HaptoFlow.Editor
{
    /// <summary>Everything that can be set in the Texture Preview window, undoable.</summary>
    internal sealed class TexturePreviewState : ScriptableObject
    {
        public const float MinimumSpeedMps = 0.002f;
        public const float MaximumSpeedMps = 2f;
        public const float MinimumForceNewtons = 0.05f;
        public const float MaximumForceNewtons = 5f;
        public const float MaximumSeconds = 8f;
        public const float MinimumLandingMps = 0.01f;
        public const float MaximumLandingMps = 2f;

        /// <summary>Null for the project's.</summary>
        [field: SerializeField]
        public HapticModelAsset? Model { get; set; }

        [field: SerializeField]
        public MaterialChoice First { get; private set; } = new MaterialChoice();

        [field: SerializeField]
        public MaterialChoice Second { get; private set; } = new MaterialChoice();

        /// <summary>The second material is shown beside the first.</summary>
        [field: SerializeField]
        public bool Compares { get; set; } = true;

        /// <summary>Which material is heard and exported: 0 or 1.</summary>
        [field: SerializeField]
        public int Active { get; set; }

        [field: SerializeField]
        public StrokePreset Preset { get; set; } = StrokePreset.BackAndForth;

        [field: SerializeField]
        public float SpeedMps { get; set; } = 0.12f;

        [field: SerializeField]
        public float ForceNewtons { get; set; } = 1.5f;

        [field: SerializeField]
        public float DirectionDegrees { get; set; } = 30f;

        [field: SerializeField]
        public float ContactSeconds { get; set; } = 2.5f;

        [field: SerializeField]
        public float LandingMps { get; set; } = 0.3f;

        [field: SerializeField]
        public bool HasTexture { get; set; } = true;

        [field: SerializeField]
        public bool HasImpact { get; set; } = true;

        [field: SerializeField]
        public bool HasEdge { get; set; } = true;

        /// <summary>What the wave is felt through.</summary>
        [field: SerializeField]
        public PreviewDevice Device { get; set; }

        /// <summary>Not to be changed: set another array.</summary>
        [field: SerializeField]
        public DrawnPoint[] Drawn { get; set; } = Array.Empty<DrawnPoint>();

        /// <summary>Empty for the model's default.</summary>
        [field: SerializeField]
        public string Tier { get; set; } = "";

        /// <summary>Key of all noise.</summary>
        [field: SerializeField]
        public int Seed { get; set; } = 1;

        /// <summary>Raised until the louder of the two fills the speakers' range.</summary>
        [field: SerializeField]
        public bool Raises { get; set; } = true;

        [field: SerializeField]
        public bool Loops { get; set; }

        /// <summary>The sliders are unfolded.</summary>
        [field: SerializeField]
        public bool ShowsSliders { get; set; }

        /// <summary>Another number whenever something may be different.</summary>
        public int Version { get; private set; }

        /// <summary>A device's rendering takes the second material's place.</summary>
        public bool ShowsDevice => Device != PreviewDevice.Actuator;

        /// <summary>The second material is shown.</summary>
        public bool ShowsSecond => Compares && !ShowsDevice;

        /// <summary>The active one among those that are shown.</summary>
        public int PlayedIndex => Compares || ShowsDevice ? Active : 0;

        public StrokeSettings Settings =>
            new StrokeSettings(SpeedMps, ForceNewtons, DirectionDegrees, ContactSeconds, LandingMps);

        public HapticEffects Effects
        {
            get
            {
                HapticEffects asked = (HasTexture ? HapticEffects.Texture : 0) |
                    (HasImpact ? HapticEffects.Impact : 0) | (HasEdge ? HapticEffects.Edge : 0);
                return asked == HapticEffects.Unspecified ? HapticEffects.Nothing : asked;
            }
        }

        public MaterialChoice Material(int index) => index == 0 || ShowsDevice ? First : Second;

        public IReadOnlyList<LabelMix> Mixes(IReadOnlyList<string> labels)
        {
            LabelMix first = First.Mix(labels, 0);
            return ShowsSecond ? new[] { first, Second.Mix(labels, 1) } : new[] { first };
        }

        /// <summary>The one of <see cref="Mixes"/> that is heard, or that a device plays.</summary>
        public LabelMix PlayedMix(IReadOnlyList<string> labels) => Mixes(labels)[ShowsDevice ? 0 : PlayedIndex];

        /// <summary>Makes a change that can be undone.</summary>
        /// <param name="what">Of the undo's name, for example "Speed".</param>
        public void Change(string what, Action<TexturePreviewState> change)
        {
            Undo.RecordObject(this, "Texture Preview " + what);
            change(this);
            ++Version;
        }

        /// <summary>The material that is heard becomes this one; can be undone.</summary>
        /// <param name="learnt">In the place of the mix's first label; null for the label.</param>
        public void Take(LabelMix mix, HapticMaterial? learnt) =>
            Change("Material", changed => changed.Material(changed.PlayedIndex).Take(mix, learnt));

        /// <summary>Something was undone or done again.</summary>
        public void MarkChanged() => ++Version;
    }
}
