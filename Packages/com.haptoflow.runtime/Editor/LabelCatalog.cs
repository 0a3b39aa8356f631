#nullable enable
using System;
using System.Collections.Generic;
using System.Globalization;
using System.Linq;
using HaptoFlow.Model;

namespace HaptoFlow.Editor
{
    /// <summary>The labels that can be chosen: those of the project's model, or of the package's model if the project
    /// names none. They are read again when the model changes. Main thread.</summary>
    internal sealed class LabelCatalog
    {
        private static LabelCatalog? current;

        private readonly byte[] file;
        private readonly Dictionary<string, string> texts = new Dictionary<string, string>(StringComparer.Ordinal);
        private readonly Dictionary<string, string> stiffness =
            new Dictionary<string, string>(LabelSpelling.Same);

        private LabelCatalog(byte[] file, HapticModelAsset? model)
        {
            this.file = file;
            IReadOnlyList<HapticLabel> labels = LabelsOf(model);
            Names = new LabelNames(labels.Select(label => label.Name));
            foreach (HapticLabel label in labels)
            {
                stiffness[label.Name] = string.Format(
                    CultureInfo.InvariantCulture, "0: the model's {0:0}", label.StiffnessNewtonsPerMetre);
            }
        }

        /// <summary>The current labels; empty when the project has no usable model.</summary>
        public static LabelCatalog Current
        {
            get
            {
                HapticModelAsset? model = ModelInUse();
                byte[] file = model != null ? model.File : Array.Empty<byte>();
                if (current == null || !ReferenceEquals(current.file, file))
                {
                    current = new LabelCatalog(file, model);
                }
                return current;
            }
        }

        public LabelNames Names { get; }

        /// <summary>Whether the model lacks a label of this name. False when there is no model.</summary>
        public bool IsUnknown(string name) =>
            name.Length > 0 && Names.All.Count > 0 && !Names.TryFind(name, out _);

        /// <summary>The name, with a remark if the model does not have it; "none" for an empty name.</summary>
        public string TextOf(string name)
        {
            if (!texts.TryGetValue(name, out string text))
            {
                text = name.Length == 0 ? "none" : IsUnknown(name) ? name + " (not in model)" : name;
                texts[name] = text;
            }
            return text;
        }

        /// <summary>The stiffness that 0 stands for, as text; empty for an unknown label.</summary>
        public string StiffnessRemark(string name) =>
            stiffness.TryGetValue(name, out string remark) ? remark : "";

        /// <summary>The project's model, else the package's own; null when neither exists.</summary>
        public static HapticModelAsset? ModelInUse()
        {
            HaptoFlowSettings? settings = ProjectSettingsAsset.Find();
            HapticModelAsset? chosen = settings != null ? settings.Model : null;
            return chosen != null ? chosen : ProjectSettingsAsset.DefaultModel();
        }

        private static IReadOnlyList<HapticLabel> LabelsOf(HapticModelAsset? model)
        {
            try
            {
                return model != null ? model.Header.Labels : Array.Empty<HapticLabel>();
            }
            catch (HaptoFlowException)
            {
                // The model's Inspector and the scene check report the problem.
                return Array.Empty<HapticLabel>();
            }
        }
    }
}
