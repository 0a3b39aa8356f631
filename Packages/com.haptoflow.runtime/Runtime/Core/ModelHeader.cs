#nullable enable
using System;
using System.Collections.Generic;
using System.Linq;
using System.Text;
using HaptoFlow.Native;

namespace HaptoFlow.Model
{
    /// <summary>Provenance of a model.</summary>
    public sealed class ModelProvenance
    {
        internal ModelProvenance(in ModelInfo info)
        {
            Statement = NativeCall.Text(info.Statement);
            Recordings = NativeCall.Text(info.Recordings);
            Licence = NativeCall.Text(info.Licence);
            Commit = NativeCall.Text(info.Commit);
            Created = NativeCall.Text(info.Created);
        }

        /// <summary>One sentence, for example "trained on synthetic recordings".</summary>
        public string Statement { get; }

        /// <summary>The recordings that the model was trained on.</summary>
        public string Recordings { get; }

        /// <summary>Licence of the recordings.</summary>
        public string Licence { get; }

        /// <summary>Commit of the training code.</summary>
        public string Commit { get; }

        /// <summary>Date as YYYY-MM-DD, or empty.</summary>
        public string Created { get; }
    }

    /// <summary>The interval of the speeds or forces that a model was trained on, or a material learnt from.</summary>
    public readonly struct TrainedInterval
    {
        internal TrainedInterval(double minimum, double maximum) => (Minimum, Maximum) = (minimum, maximum);

        /// <summary>Lower limit, in the unit of the property that holds the interval.</summary>
        public double Minimum { get; }

        /// <summary>Upper limit, in the unit of the property that holds the interval.</summary>
        public double Maximum { get; }
    }

    /// <summary>The header of a .haptoflow file as the native library reads it, which also verifies the rest of the
    /// file. Immutable; any thread.</summary>
    public sealed unsafe class ModelHeader
    {
        internal ModelHeader(
            in ModelInfo info, string space, IReadOnlyList<HapticLabel> labels, IReadOnlyList<HapticTier> tiers)
        {
            Name = NativeCall.Text(info.Name);
            Description = NativeCall.Text(info.Description);
            Provenance = new ModelProvenance(info);
            SpeedMps = new TrainedInterval(info.SpeedMps[0], info.SpeedMps[1]);
            ForceNewtons = new TrainedInterval(info.ForceNewtons[0], info.ForceNewtons[1]);
            Space = space;
            Labels = labels;
            Tiers = tiers;
        }

        /// <summary>Name for display.</summary>
        public string Name { get; }

        /// <summary>One or two sentences.</summary>
        public string Description { get; }

        /// <summary>Provenance of the model.</summary>
        public ModelProvenance Provenance { get; }

        /// <summary>Speeds that the network was trained on, in m/s.</summary>
        public TrainedInterval SpeedMps { get; }

        /// <summary>Forces that the network was trained on, in N.</summary>
        public TrainedInterval ForceNewtons { get; }

        /// <summary>Identifies the space of the embeddings: see <see cref="HapticModel.Space"/>.</summary>
        public string Space { get; }

        /// <summary>The labels in the order of their indices.</summary>
        public IReadOnlyList<HapticLabel> Labels { get; }

        /// <summary>The tiers in order of increasing accuracy.</summary>
        public IReadOnlyList<HapticTier> Tiers { get; }

        /// <summary>The tier that is used unless another is selected.</summary>
        public HapticTier DefaultTier => Tiers.Single(tier => tier.IsDefault);

        /// <summary>The tier that an engine of this quality plays, as haptoflow.h says it (haptoflow_quality).</summary>
        internal HapticTier TierOf(HapticQuality quality) => quality switch
        {
            HapticQuality.Sketch => Named("sketch") ?? Tiers[0],
            HapticQuality.Draft => Named("draft") ?? Tiers[0],
            _ => Named("standard") ?? DefaultTier,
        };

        private HapticTier? Named(string name) => Tiers.FirstOrDefault(tier => tier.Name == name);

        /// <param name="file">The whole .haptoflow file; the array is not kept.</param>
        /// <exception cref="HaptoFlowException">The library is missing, or the bytes are not a usable model; the
        /// message says why.</exception>
        public static ModelHeader Read(byte[] file)
        {
            using HapticModel model = HapticModel.Open(file);
            return model.Header;
        }
    }

    /// <summary>Finds labels by name, and suggests labels for a misspelt name.</summary>
    public sealed class LabelNames
    {
        private const int RememberedSpellings = 1024;

        private readonly Dictionary<string, int> indices = new Dictionary<string, int>(LabelSpelling.Same);

        // Spellings that were asked for: a surface asks each frame, and a comparison beyond ASCII allocates.
        private readonly Dictionary<string, int> asked = new Dictionary<string, int>(StringComparer.Ordinal);
        private readonly string[] names;

        /// <param name="labels">Names in the order of their indices.</param>
        public LabelNames(IEnumerable<string> labels)
        {
            names = labels.ToArray();
            for (int index = 0; index < names.Length; ++index)
            {
                indices[names[index]] = index;
            }
        }

        /// <summary>Names in the order of their indices.</summary>
        public IReadOnlyList<string> All => names;

        /// <summary>Finds the index of a name; case and the form of accents are ignored (<see cref="LabelSpelling"/>).
        /// One thread at a time.</summary>
        public bool TryFind(string name, out int index)
        {
            if (!asked.TryGetValue(name, out index))
            {
                index = indices.TryGetValue(name, out int found) ? found : -1;
                if (asked.Count < RememberedSpellings)
                {
                    asked[name] = index;
                }
            }
            bool isKnown = index >= 0;
            index = Math.Max(index, 0);
            return isKnown;
        }

        /// <summary>Up to three labels with at most two different letters, or of which one name contains the other, in
        /// order of similarity.</summary>
        public IReadOnlyList<string> NearMatches(string name)
        {
            string wanted = name.Trim().ToLowerInvariant();
            return names
                .Select(label => (label, distance: Distance(wanted, label.ToLowerInvariant())))
                .Where(match => match.distance <= 2 || Holds(wanted, match.label.ToLowerInvariant()))
                .OrderBy(match => match.distance)
                .ThenBy(match => match.label, StringComparer.Ordinal)
                .Select(match => match.label)
                .Take(3)
                .ToArray();
        }

        private static bool Holds(string wanted, string label) =>
            wanted.Length >= 3 && (label.Contains(wanted) || wanted.Contains(label));

        /// <summary>Edit distance: letters to insert, delete or replace (Levenshtein 1966); .NET has none.</summary>
        private static int Distance(string a, string b)
        {
            int[] row = Enumerable.Range(0, b.Length + 1).ToArray();
            for (int i = 1; i <= a.Length; ++i)
            {
                int diagonal = row[0];
                row[0] = i;
                for (int j = 1; j <= b.Length; ++j)
                {
                    int above = row[j];
                    int replaced = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
                    row[j] = Math.Min(Math.Min(above, row[j - 1]) + 1, replaced);
                    diagonal = above;
                }
            }
            return row[b.Length];
        }
    }

    /// <summary>Compares labels as every reader of HaptoFlow does: case and the form of accents (composed or not) do not
    /// matter, the language of the machine neither. Native code does the same, by the golden file Tests/Golden/labels.
    /// Any thread.</summary>
    public sealed class LabelSpelling : IEqualityComparer<string>
    {
        /// <summary>The one comparer.</summary>
        public static readonly LabelSpelling Same = new LabelSpelling();

        private LabelSpelling()
        {
        }

        /// <summary>True for two spellings of one label. Allocates only where one has letters beyond ASCII.</summary>
        public bool Equals(string? first, string? second) =>
            string.Equals(Key(first), Key(second), StringComparison.OrdinalIgnoreCase);

        /// <summary>The same number for all spellings of one label.</summary>
        public int GetHashCode(string label) => StringComparer.OrdinalIgnoreCase.GetHashCode(Key(label)!);

        /// <summary>The text with each accent joined to its letter (Unicode form C), so that the same word has the same
        /// characters. ASCII is returned as it is.</summary>
        internal static string Composed(string text) => Normalized(text, NormalizationForm.FormC);

        // Mono, unlike .NET, has no capital for the sigma that ends a word.
        private static string? Key(string? label) =>
            label == null ? null : Normalized(label, NormalizationForm.FormD).Replace('\u03C2', '\u03C3');

        private static string Normalized(string text, NormalizationForm form)
        {
            try
            {
                return IsAscii(text) ? text : text.Normalize(form);
            }
            catch (ArgumentException)
            {
                // Half of a surrogate pair is no text; it is compared as it is.
                return text;
            }
        }

        private static bool IsAscii(string text)
        {
            foreach (char letter in text)
            {
                if (letter > '\x7F')
                {
                    return false;
                }
            }
            return true;
        }
    }
}
