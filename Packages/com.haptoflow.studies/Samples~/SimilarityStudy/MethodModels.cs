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
            foreach (StudyMethod each in settings.methods)
            {
                loaded.Add(each.name, Haptics.Load(each.model!, each.Quality));
            }
        }

        /// <summary>Whether every model is loaded, has every material, and is measured.</summary>
        public bool IsReady => inferenceMilliseconds.Count == settings.methods.Length;

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

        public HapticLoadedModel Of(string method) => loaded[method];

        /// <summary>The delay that a method adds, in ms.</summary>
        public double InferenceMilliseconds(string method) => inferenceMilliseconds[method];

        public StudyModel[] ForLog() => settings.methods
            .Select(each => new StudyModel(each.name, FileOf(each), Hash.Sha256(each.model!.File)))
            .ToArray();

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
            foreach (StudyMethod each in settings.methods)
            {
                HapticLoadedModel model = loaded[each.name];
                string? problem = model.Problem;
                if (problem != null)
                {
                    throw new StudyException($"method \"{each.name}\": {FileOf(each)} cannot be used: {problem}");
                }
                all &= model.IsReady;
            }
            return all;
        }

        // Every pair is asked, so that all materials are prepared at once.
        private bool AllMaterialsAreKnown() => settings.methods
            .SelectMany(method => settings.materials.Select(material => IsKnown(method, material)))
            .ToArray().All(isKnown => isKnown);

        private bool IsKnown(StudyMethod method, StudyMaterial material)
        {
            HapticLoadedModel model = loaded[method.name];
            HapticMaterial? asset = material.material;
            if (asset != null && asset.IsLearnt)
            {
                Doing = $"preparing \"{material.name}\" for \"{method.name}\"";
                bool isPrepared = model.TryPrepare(asset, out string? refusal);
                return refusal == null
                    ? isPrepared
                    : throw new StudyException($"material \"{material.name}\": the model of method \"{method.name}\" " +
                        $"cannot generate it: {refusal}; learn it for that model too, or compare by label");
            }
            foreach (string label in LabelsOf(material))
            {
                if (!model.Labels.Contains(label, LabelSpelling.Same))
                {
                    throw new StudyException($"material \"{material.name}\": the model of method \"{method.name}\" " +
                        $"has no label \"{label}\"; its labels are {string.Join(", ", model.Labels)}");
                }
            }
            return true;
        }

        private static IEnumerable<string> LabelsOf(StudyMaterial material)
        {
            if (material.material == null)
            {
                return new[] { material.label };
            }
            MaterialDescription description = material.material.Description;
            return new[] { description.Label, description.SecondLabel }.Where(label => label.Length > 0);
        }

        /// <summary>Refuses two methods with one tier of one model, which would be compared with themselves.</summary>
        private void RefuseEqualMethods()
        {
            var equal = settings.methods
                .GroupBy(each => (File: Hash.Sha256(each.model!.File), Tier: loaded[each.name].TierName))
                .FirstOrDefault(group => group.Count() > 1);
            if (equal != null)
            {
                string[] names = equal.Select(each => each.name).ToArray();
                throw new StudyException($"the methods \"{names[0]}\" and \"{names[1]}\" are the same tier " +
                    $"\"{equal.Key.Tier}\" of the same model; leave one out, or choose another quality");
            }
        }

        private void MeasureNext()
        {
            StudyMethod next = settings.methods[inferenceMilliseconds.Count];
            Doing = $"measuring the delay of \"{next.name}\"; keep the pen away";
            measuring ??= measure(next, loaded[next.name]);
            if (!measuring.IsCompleted)
            {
                return;
            }
            Task<double> ended = measuring;
            measuring = null;
            if (ended.Status != TaskStatus.RanToCompletion)
            {
                throw new StudyException($"method \"{next.name}\": its delay could not be measured: " +
                    (ended.Exception?.GetBaseException().Message ?? "the measurement was cancelled"));
            }
            inferenceMilliseconds.Add(next.name, ended.Result);
        }

        private static string FileOf(StudyMethod method) => method.model!.name + ".haptoflow";
    }

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
