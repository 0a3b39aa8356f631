#nullable enable
using System;
using System.Collections.Generic;
using System.Linq;
using System.Threading.Tasks;
using HaptoFlow.Studies;

namespace HaptoFlow.Samples.SimilarityStudy
{
    /// <summary>The models of a study's methods: loaded side by side before the first trial, checked against the
    /// materials, and measured one after another. What is wrong with one stops the study before it begins. Main thread.
    /// </summary>
    public sealed class MethodModels : IDisposable
    {
        private readonly SimilarityStudySettings settings;
        private readonly Func<StudyMethod, HapticLoadedModel, Task<double>> measure;
        private readonly Dictionary<string, HapticLoadedModel> loaded =
            new Dictionary<string, HapticLoadedModel>(StringComparer.Ordinal);
        private readonly Dictionary<string, double> inference = new Dictionary<string, double>(StringComparer.Ordinal);
        private Task<double>? measuring;
        private bool isChecked;

        /// <param name="measure">What a method adds to the delay, in ms.</param>
        public MethodModels(
            SimilarityStudySettings settings, Func<StudyMethod, HapticLoadedModel, Task<double>> measure)
        {
            this.settings = settings;
            this.measure = measure;
            foreach (StudyMethod each in settings.Methods)
            {
                loaded.Add(each.Name, Haptics.Load(each.Model!, each.Quality));
            }
        }

        /// <summary>Every model is loaded, knows every material, and is measured.</summary>
        public bool IsReady => inference.Count == settings.Methods.Count;

        /// <summary>What the preparation waits for, for the operator.</summary>
        public string Doing { get; private set; } = "loading the models";

        /// <summary>Goes on with the preparation. Once a frame.</summary>
        /// <exception cref="StudyException">A model cannot be used; the message names the method.</exception>
        public void Update()
        {
            if (IsReady || !AllAreLoaded() || !AllMaterialsAreKnown())
            {
                return;
            }
            if (!isChecked)
            {
                isChecked = true;
                RefuseTwins();
            }
            MeasureNext();
        }

        /// <summary>From the next frame on the pen feels by the method's model.</summary>
        public void Use(string method) => loaded[method].Use();

        /// <summary>The method's model.</summary>
        public HapticLoadedModel Of(string method) => loaded[method];

        /// <summary>What the method adds to the delay, in ms.</summary>
        public double InferenceMilliseconds(string method) => inference[method];

        /// <summary>For the sidecar: which file each method played.</summary>
        public StudyModel[] ForLog() => settings.Methods
            .Select(each => new StudyModel(each.Name, FileOf(each), Hash.Sha256(each.Model!.File)))
            .ToArray();

        /// <summary>Closes the models.</summary>
        public void Dispose()
        {
            foreach (HapticLoadedModel each in loaded.Values)
            {
                each.Dispose();
            }
            loaded.Clear();
        }

        private bool AllAreLoaded()
        {
            bool all = true;
            foreach (StudyMethod each in settings.Methods)
            {
                HapticLoadedModel model = loaded[each.Name];
                string? problem = model.Problem;
                if (problem != null)
                {
                    throw new StudyException($"method \"{each.Name}\": {FileOf(each)} cannot be used: {problem}");
                }
                all &= model.IsReady;
            }
            return all;
        }

        private bool AllMaterialsAreKnown()
        {
            bool all = true;
            foreach (StudyMethod method in settings.Methods)
            {
                foreach (StudyMaterial material in settings.Materials)
                {
                    all &= IsKnown(method, material);
                }
            }
            return all;
        }

        private bool IsKnown(StudyMethod method, StudyMaterial material)
        {
            HapticLoadedModel model = loaded[method.Name];
            HapticMaterial? asset = material.Material;
            if (asset != null && asset.IsLearnt)
            {
                Doing = $"preparing \"{material.Name}\" for \"{method.Name}\"";
                bool isFelt = model.TryPrepare(asset, out string? refusal);
                return refusal == null
                    ? isFelt
                    : throw new StudyException($"material \"{material.Name}\": the model of method \"{method.Name}\" " +
                        $"cannot make it felt: {refusal}; learn it for that model too, or compare by label");
            }
            foreach (string label in LabelsOf(material))
            {
                if (!model.Labels.Contains(label, StringComparer.OrdinalIgnoreCase))
                {
                    throw new StudyException($"material \"{material.Name}\": the model of method \"{method.Name}\" " +
                        $"has no label \"{label}\"; its labels are {string.Join(", ", model.Labels)}");
                }
            }
            return true;
        }

        private static IEnumerable<string> LabelsOf(StudyMaterial material)
        {
            if (material.Material == null)
            {
                return new[] { material.Label };
            }
            MaterialDescription description = material.Material.Description;
            return new[] { description.Label, description.SecondLabel }.Where(label => label.Length > 0);
        }

        /// <summary>Two methods that are the same would be compared with each other.</summary>
        private void RefuseTwins()
        {
            var known = new Dictionary<string, string>(StringComparer.Ordinal);
            foreach (StudyMethod each in settings.Methods)
            {
                string tier = loaded[each.Name].TierName;
                string key = Hash.Sha256(each.Model!.File) + tier;
                if (known.TryGetValue(key, out string other))
                {
                    throw new StudyException(
                        $"the methods \"{other}\" and \"{each.Name}\" are the same tier \"{tier}\" of the same model; " +
                        "leave one out, or choose another quality");
                }
                known.Add(key, each.Name);
            }
        }

        private void MeasureNext()
        {
            StudyMethod next = settings.Methods[inference.Count];
            Doing = $"measuring the delay of \"{next.Name}\"; keep the pen away";
            measuring ??= measure(next, loaded[next.Name]);
            if (!measuring.IsCompleted)
            {
                return;
            }
            Task<double> ended = measuring;
            measuring = null;
            if (ended.Status != TaskStatus.RanToCompletion)
            {
                throw new StudyException($"method \"{next.Name}\": its delay could not be measured: " +
                    (ended.Exception?.GetBaseException().Message ?? "the measurement was cancelled"));
            }
            inference.Add(next.Name, ended.Result);
        }

        private static string FileOf(StudyMethod method) => method.Model!.name + ".haptoflow";
    }
}
