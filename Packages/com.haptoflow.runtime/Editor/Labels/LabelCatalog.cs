#nullable enable
using System;
using System.Collections.Generic;
using System.Globalization;
using System.Linq;
using HaptoFlow.Model;

namespace HaptoFlow.Editor
{
    /// <summary>The labels that can be chosen: those of the project's model, or of the package's own where none is
    /// chosen. Main thread; read anew only when the model is another.</summary>
    internal sealed class LabelCatalog
    {
        private static LabelCatalog? current;

        private readonly byte[] file;
        private readonly Dictionary<string, string> shown = new Dictionary<string, string>(StringComparer.Ordinal);
        private readonly Dictionary<string, string> stiffness =
            new Dictionary<string, string>(StringComparer.OrdinalIgnoreCase);

        private LabelCatalog(byte[] file)
        {
            this.file = file;
            IReadOnlyList<ModelLabel> labels = LabelsOf(file);
            Names = new LabelNames(labels.Select(label => label.Name));
            foreach (ModelLabel label in labels)
            {
                stiffness[label.Name] = string.Format(
                    CultureInfo.InvariantCulture, "0: the model's {0:0}", label.StiffnessNewtonsPerMetre);
            }
        }

        /// <summary>Never null; empty where the project has no usable model.</summary>
        public static LabelCatalog Current
        {
            get
            {
                byte[] wanted = ModelInUse()?.File ?? Array.Empty<byte>();
                if (current == null || !ReferenceEquals(current.file, wanted))
                {
                    current = new LabelCatalog(wanted);
                }
                return current;
            }
        }

        public LabelNames Names { get; }

        /// <summary>False for every name where there is no model: then nobody can tell.</summary>
        public bool IsUnknown(string name) =>
            name.Length > 0 && Names.All.Count > 0 && !Names.TryFind(name, out _);

        /// <summary>The name, with a remark where the model does not have it; "none" for an empty one.</summary>
        public string TextOf(string name)
        {
            if (!shown.TryGetValue(name, out string text))
            {
                text = name.Length == 0 ? "none" : IsUnknown(name) ? name + " (not in model)" : name;
                shown[name] = text;
            }
            return text;
        }

        /// <summary>What a stiffness of 0 stands for; empty where the label is not known.</summary>
        public string StiffnessRemark(string name) =>
            stiffness.TryGetValue(name, out string remark) ? remark : "";

        public static HapticModelAsset? ModelInUse()
        {
            HaptoFlowSettings? settings = ProjectSettingsAsset.Find();
            HapticModelAsset? chosen = settings != null ? settings.Model : null;
            return chosen != null ? chosen : ProjectSettingsAsset.DefaultModel();
        }

        private static IReadOnlyList<ModelLabel> LabelsOf(byte[] file)
        {
            try
            {
                return ModelHeader.Read(file).Labels;
            }
            catch (HaptoFlowException)
            {
                // The model's own Inspector and the scene check say what is wrong with it.
                return Array.Empty<ModelLabel>();
            }
        }
    }
}
