#nullable enable
using System;
using System.Collections.Generic;
using System.Linq;

namespace HaptoFlow.Model
{
    /// <summary>Provenance of a model.</summary>
    public sealed class ModelProvenance
    {
        internal ModelProvenance(JsonValue json)
        {
            Statement = json["statement"].AsText();
            Recordings = json["recordings"].AsText();
            Licence = json["licence"].AsText();
            Commit = json["commit"].AsText();
            Created = json["created"].AsText();
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

    /// <summary>A trained interval and the 5th, 25th, 50th, 75th and 95th percentile of the training samples in it.
    /// </summary>
    public sealed class TrainedInterval
    {
        internal TrainedInterval(JsonValue bounds, JsonValue percentiles)
        {
            double[] edges = bounds.AsArray().Select(edge => edge.AsNumber()).ToArray();
            if (edges.Length != 2 || !(edges[0] >= 0.0 && edges[0] < edges[1]))
            {
                throw bounds.Expected("[min, max] with min below max");
            }
            Minimum = edges[0];
            Maximum = edges[1];
            Percentiles = percentiles.AsArray().Select(value => value.AsNumber()).ToArray();
        }

        /// <summary>Lower limit, in the unit of the property that holds the interval.</summary>
        public double Minimum { get; }

        /// <summary>Upper limit, in the unit of the property that holds the interval.</summary>
        public double Maximum { get; }

        /// <summary>The 5th, 25th, 50th, 75th and 95th percentile.</summary>
        public IReadOnlyList<double> Percentiles { get; }
    }

    /// <summary>A label in the header.</summary>
    public sealed class ModelLabel
    {
        internal ModelLabel(JsonValue json)
        {
            Name = json["name"].AsText();
            Category = json["category"].AsText();
            StiffnessNewtonsPerMetre = json["stiffness_newtons_per_metre"].AsNumber();
            FrictionCoefficient = json["friction_coefficient"].AsNumber();
            WavelengthMetres = json["periodic"].AsBoolean() ? json["wavelength_metres"].AsNumber() : (double?)null;
        }

        /// <summary>Name, lower case and unique in the model.</summary>
        public string Name { get; }

        /// <summary>For example "wood" or "cloth".</summary>
        public string Category { get; }

        /// <summary>Default stiffness of the spring model.</summary>
        public double StiffnessNewtonsPerMetre { get; }

        /// <summary>Mean coefficient of kinetic friction.</summary>
        public double FrictionCoefficient { get; }

        /// <summary>Wavelength of a woven or ruled surface; null for others.</summary>
        public double? WavelengthMetres { get; }
    }

    /// <summary>A tier in the header.</summary>
    public sealed class ModelTier
    {
        internal ModelTier(JsonValue json)
        {
            Name = json["name"].AsText();
            Kind = json["kind"].AsText();
            Solver = json["solver"].AsText();
            Steps = json["steps"].AsInteger();
            ParameterCount = (long)json["parameters"].AsNumber();
            Representation = json["representation"].AsText();
            Accuracy = json["accuracy"];
            Cost = json["cost"];
        }

        /// <summary>Usually "draft", "standard" or "fine".</summary>
        public string Name { get; }

        /// <summary>"flow", "average-velocity" or "direct".</summary>
        public string Kind { get; }

        /// <summary>"euler", "midpoint" or "heun".</summary>
        public string Solver { get; }

        /// <summary>Solver steps, 1 to 16.</summary>
        public int Steps { get; }

        /// <summary>Number of weights of the network.</summary>
        public long ParameterCount { get; }

        /// <summary>"raw" or "latent".</summary>
        public string Representation { get; }

        /// <summary>Measured figures, an empty object where nothing was measured.</summary>
        public JsonValue Accuracy { get; }

        /// <summary>Measured figures, an empty object where nothing was measured.</summary>
        public JsonValue Cost { get; }
    }

    /// <summary>The header of a .haptoflow file, read without the native library: for inspectors, label lists and
    /// platforms without a binary. The networks are checked when the native library opens the file.</summary>
    public sealed class ModelHeader
    {
        private ModelHeader(JsonValue json)
        {
            Name = json["name"].AsText();
            Description = json["description"].AsText();
            Provenance = new ModelProvenance(json["provenance"]);
            JsonValue range = json["range"];
            SpeedMps = new TrainedInterval(range["speed_mps"], range["speed_percentiles_mps"]);
            ForceNewtons = new TrainedInterval(range["force_newtons"], range["force_percentiles_newtons"]);
            Labels = json["labels"].AsArray().Select(label => new ModelLabel(label)).ToArray();
            Tiers = json["tiers"].AsArray().Select(tier => new ModelTier(tier)).ToArray();
            JsonValue defaultTier = json["default_tier"];
            DefaultTier = Tiers.FirstOrDefault(tier => tier.Name == defaultTier.AsText()) ??
                throw defaultTier.Expected("the name of a tier");
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

        /// <summary>The labels in the order of their indices.</summary>
        public IReadOnlyList<ModelLabel> Labels { get; }

        /// <summary>The tiers in order of increasing accuracy.</summary>
        public IReadOnlyList<ModelTier> Tiers { get; }

        /// <summary>The tier that is used unless another is selected.</summary>
        public ModelTier DefaultTier { get; }

        /// <param name="file">The whole .haptoflow file.</param>
        /// <exception cref="HaptoFlowException">The bytes break a rule of the format; the message names it.</exception>
        public static ModelHeader Read(ReadOnlySpan<byte> file)
        {
            string text = ModelFile.HeaderText(file);
            try
            {
                return new ModelHeader(JsonValue.Parse(text));
            }
            catch (FormatException error)
            {
                throw new HaptoFlowException(
                    HaptoFlowStatus.ModelInconsistent, "the JSON header: " + error.Message, error);
            }
        }
    }
}
