#nullable enable
using System;
using System.Collections.Generic;
using System.Linq;
using HaptoFlow.Studies;
using UnityEngine;
using Object = UnityEngine.Object;

namespace HaptoFlow.Samples.SimilarityStudy
{
    /// <summary>What a trial is made of: two objects that look alike, a pen, an output, the methods' models, the
    /// materials, and one delay for all. Main thread.</summary>
    public sealed class TrialParts : IDisposable
    {
        private readonly MethodModels models;
        private readonly StudyRig rig;
        private readonly Dictionary<string, HapticMaterial> materials;
        private readonly List<HapticMaterial> made = new List<HapticMaterial>();

        /// <param name="settings">Whose materials are felt.</param>
        /// <param name="models">Ready to be used.</param>
        public TrialParts(SimilarityStudySettings settings, MethodModels models, EqualDelay delay, StudyObject real,
            StudyObject @virtual, StudyRig rig, HapticOutput output, RatingPanel panel, TextMesh instruction)
        {
            this.models = models;
            Delay = delay;
            Real = real;
            Virtual = @virtual;
            this.rig = rig;
            Output = output;
            Panel = panel;
            Instruction = instruction;
            materials = settings.Materials.ToDictionary(each => each.Name, FeelOf, StringComparer.Ordinal);
        }

        /// <summary>One for all methods.</summary>
        public EqualDelay Delay { get; }

        /// <summary>Lies where the real sample is, and is not felt.</summary>
        public StudyObject Real { get; }

        /// <summary>Lies beside it, and is felt.</summary>
        public StudyObject Virtual { get; }

        /// <summary>The participant's at present.</summary>
        public HapticStylus Pen => rig.Pen;

        /// <summary>The actuator's.</summary>
        public HapticOutput Output { get; }

        /// <summary>The question.</summary>
        public RatingPanel Panel { get; }

        /// <summary>What the participant reads.</summary>
        public TextMesh Instruction { get; }

        /// <summary>From the next frame on the virtual object feels as the trial's method makes its material, as late
        /// as all others.</summary>
        public void Play(PlannedTrial trial)
        {
            models.Use(trial.Method!);
            Virtual.Surface.SharedMaterial = materials[trial.Material!];
            Output.Processing.DelayMilliseconds = (float)Delay.ArtificialMilliseconds(trial.Method!);
            Output.ApplyProcessing();
        }

        /// <summary>What was made here goes.</summary>
        public void Dispose()
        {
            made.ForEach(Object.Destroy);
            made.Clear();
        }

        private HapticMaterial FeelOf(StudyMaterial material)
        {
            if (material.Material != null)
            {
                return material.Material;
            }
            var feel = ScriptableObject.CreateInstance<HapticMaterial>();
            feel.Description.Label = material.Label;
            feel.Description.Effects = HapticEffects.Texture;
            made.Add(feel);
            return feel;
        }
    }
}
