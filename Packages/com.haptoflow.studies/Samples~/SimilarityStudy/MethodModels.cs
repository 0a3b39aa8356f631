#nullable enable
using System;
using System.Collections.Generic;
using System.Linq;
using System.Security.Cryptography;
using System.Threading.Tasks;
using HaptoFlow.Model;
using HaptoFlow.Studies;

namespace HaptoFlow.Samples.SimilarityStudy
{
    /// <summary>The models of a study's methods. Before the first trial they are loaded in parallel, checked against
    /// the materials, and their delays are measured one after another. A problem with any of them stops the study
    /// before it begins. Main thread.</summary>
    public sealed class MethodModels : IDisposable
    {
        private readonly SimilarityStudySettings settings;
        private readonly Func<StudyMethod, HapticLoadedModel, Task<double>> measure;
        private readonly Dictionary<string, HapticLoadedModel> loaded =
            new Dictionary<string, HapticLoadedModel>(StringComparer.Ordinal);
        private readonly Dictionary<string, double> inferenceMilliseconds =
            new Dictionary<string, double>(StringComparer.Ordinal);
        private Task<double>? measuring;
        private bool isChecked;

        /// <param name="measure">Measures the delay that a method adds, in ms.</param>
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

        /// <summary>Whether every model is loaded, has every material, and is measured.</summary>
        public bool IsReady => inferenceMilliseconds.Count == settings.Methods.Count;

        /// <summary>The current step of the preparation, for the operator.</summary>
        public string Doing { get; private set; } = "loading the models";

        /// <summary>Continues the preparation. Call it once a frame.</summary>
        /// <exception cref="StudyException">A model cannot be used; the message names its method.</exception>
        public void Update()
        {
            if (IsReady || !AllAreLoaded() || !AllMaterialsAreKnown())
            {
                return;
            }
            if (!isChecked)
            {
                isChecked = true;
                RefuseEqualMethods();
            }
            MeasureNext();
        }

        /// <summary>Makes the pen use the method's model from the next frame on.</summary>
        public void Use(string method) => loaded[method].Use();

        /// <summary>The model of a method.</summary>
        public HapticLoadedModel Of(string method) => loaded[method];

        /// <summary>The delay that a method adds, in ms.</summary>
        public double InferenceMilliseconds(string method) => inferenceMilliseconds[method];

        /// <summary>The model file of each method, for the log.</summary>
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
                bool isPrepared = model.TryPrepare(asset, out string? refusal);
                return refusal == null
                    ? isPrepared
                    : throw new StudyException($"material \"{material.Name}\": the model of method \"{method.Name}\" " +
                        $"cannot generate it: {refusal}; learn it for that model too, or compare by label");
            }
            foreach (string label in LabelsOf(material))
            {
                if (!model.Labels.Contains(label, LabelSpelling.Same))
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

        /// <summary>Refuses two methods with one tier of one model, which would be compared with themselves.</summary>
        private void RefuseEqualMethods()
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
            StudyMethod next = settings.Methods[inferenceMilliseconds.Count];
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
            inferenceMilliseconds.Add(next.Name, ended.Result);
        }

        private static string FileOf(StudyMethod method) => method.Model!.name + ".haptoflow";
    }

    /// <summary>Hashes that identify in a log which bytes a study used.</summary>
    internal static class Hash
    {
        /// <summary>The SHA-256 of the bytes as 64 hex digits. Unity 2022.3 has no Convert.ToHexString.</summary>
        public static string Sha256(byte[] bytes)
        {
            using SHA256 hash = SHA256.Create();
            return string.Concat(hash.ComputeHash(bytes).Select(each => each.ToString("x2")));
        }
    }
}
