#nullable enable
using System;
using System.Collections.Generic;
using System.Linq;
using HaptoFlow.Native;

namespace HaptoFlow.Model
{
    /// <summary>A learnt material: the contents of a .haptomaterial file, a label with its embedding, as the native
    /// library reads and verifies it. Immutable; any thread.</summary>
    public sealed unsafe class MaterialFile
    {
        /// <summary>Number of an embedding's components that describe the texture; the last four are wave
        /// vectors.</summary>
        public const int TextureNumbers = 60;

        private MaterialFile(string text, in MaterialInfo info, IReadOnlyList<double> embedding)
        {
            Text = text;
            Embedding = embedding;
            Space = NativeCall.Text(info.Space);
            Name = NativeCall.Text(info.Name);
            Category = NativeCall.Text(info.Category);
            Description = NativeCall.Text(info.Description);
            Statement = NativeCall.Text(info.Statement);
            Recordings = NativeCall.Text(info.Recordings);
            Licence = NativeCall.Text(info.Licence);
            Created = NativeCall.Text(info.Created);
            Seconds = info.Seconds;
            StiffnessNewtonsPerMetre = info.StiffnessNewtonsPerMetre;
            LevelOffsetDecibels = info.LevelOffsetDecibels;
            SpeedMps = new TrainedInterval(info.SpeedMps[0], info.SpeedMps[1]);
            ForceNewtons = new TrainedInterval(info.ForceNewtons[0], info.ForceNewtons[1]);
        }

        /// <summary>The <see cref="HapticModel.Space"/> of the model that the material was learnt for.</summary>
        public string Space { get; }

        /// <summary>Name for display.</summary>
        public string Name { get; }

        /// <summary>For example "wood" or "cloth".</summary>
        public string Category { get; }

        /// <summary>One or two sentences; may be empty.</summary>
        public string Description { get; }

        /// <summary>How the material was made.</summary>
        public string Statement { get; }

        /// <summary>The recordings that the material was learnt from.</summary>
        public string Recordings { get; }

        /// <summary>Licence of the recordings; "unknown" where not given.</summary>
        public string Licence { get; }

        /// <summary>Duration of the recordings in seconds; 0 where not given.</summary>
        public double Seconds { get; }

        /// <summary>Date as YYYY-MM-DD, or empty.</summary>
        public string Created { get; }

        /// <summary>The embedding, <see cref="HapticModel.EmbeddingSize"/> numbers.</summary>
        public IReadOnlyList<double> Embedding { get; }

        /// <summary>Default stiffness of the spring model.</summary>
        public double StiffnessNewtonsPerMetre { get; }

        /// <summary>Offset of the level, in dB.</summary>
        public double LevelOffsetDecibels { get; }

        /// <summary>Speeds of the recordings, in m/s.</summary>
        public TrainedInterval SpeedMps { get; }

        /// <summary>Forces of the recordings, in N.</summary>
        public TrainedInterval ForceNewtons { get; }

        internal string Text { get; }

        /// <param name="text">The whole .haptomaterial file.</param>
        /// <exception cref="HaptoFlowException">The library is missing, or the text is not a material file; the message
        /// names the key.</exception>
        public static MaterialFile Read(string text)
        {
            LibraryAgreement.Require();
            byte[] json = NativeCall.Utf8(text);
            IntPtr opened;
            fixed (byte* bytes = json)
            {
                NativeCall.Check(NativeMethods.MaterialRead(bytes, (ulong)json.Length - 1, &opened));
            }
            using var material = new NativeHandle(opened, NativeMethods.MaterialClose);
            var info = new MaterialInfo { StructSize = (uint)sizeof(MaterialInfo) };
            NativeCall.Check(NativeMethods.MaterialDescribe(material.Value, &info));
            var embedding = new float[HapticModel.EmbeddingSize];
            fixed (float* numbers = embedding)
            {
                NativeCall.Check(NativeMethods.MaterialEmbedding(material.Value, numbers));
            }
            return new MaterialFile(text, info, Array.ConvertAll(embedding, number => (double)number));
        }
    }

    /// <summary>Writes material files: from a label of a model, and copies of materials with changes.</summary>
    internal static class MaterialText
    {
        private static readonly string[] LabelKeys =
        {
            "name", "category", "level_exponents", "frequency_exponent", "periodic", "wavelength_metres",
            "stiffness_newtons_per_metre", "friction_coefficient", "impact", "level", "tone", "level_offset_db",
            "stick_slip", "rib_wander", "impulse_gain",
        };

        public static string OfLabel(byte[] file, string label)
        {
            using HapticModel model = HapticModel.Open(file);
            return OfLabel(model, label);
        }

        /// <summary>The material file of a label. It has no seeds: if the model needs seeds, its own apply.</summary>
        /// <exception cref="HaptoFlowException">The model has no such label.</exception>
        public static string OfLabel(HapticModel model, string label)
        {
            JsonValue header = JsonValue.Parse(model.HeaderJson());
            JsonValue[] labels = header["labels"].AsArray().ToArray();
            int index = Array.FindIndex(labels, each => each["name"].AsText() == label);
            if (index < 0)
            {
                throw new HaptoFlowException(HaptoFlowStatus.InvalidArgument, $"the model has no label \"{label}\"");
            }
            JsonValue provenance = header["provenance"];
            var members = new Dictionary<string, object?>
            {
                ["format"] = "haptoflow-material",
                ["version"] = 1,
                ["space"] = model.Space,
                ["description"] = "",
                ["provenance"] = new Dictionary<string, object?>
                {
                    ["statement"] = $"the label {label} of the model {header["name"].AsText()}",
                    ["recordings"] = provenance["recordings"].AsText(),
                    ["licence"] = provenance["licence"].AsText(),
                    ["seconds"] = 0.0,
                    ["created"] = provenance["created"].AsText(),
                },
                ["embedding"] = model.Embedding(index),
                ["range"] = new Dictionary<string, object?>
                {
                    ["speed_mps"] = header["range"]["speed_mps"],
                    ["force_newtons"] = header["range"]["force_newtons"],
                },
            };
            foreach (string key in LabelKeys)
            {
                JsonValue? value = labels[index].Find(key);
                if (value is { IsNull: false } || key == "wavelength_metres")
                {
                    members[key] = value;
                }
            }
            return JsonText.Of(members);
        }

        public static string With(MaterialFile material, IReadOnlyDictionary<string, object?> changes)
        {
            var members = new Dictionary<string, object?>();
            foreach (KeyValuePair<string, JsonValue> member in JsonValue.Parse(material.Text).AsObject())
            {
                members[member.Key] = member.Value;
            }
            foreach (KeyValuePair<string, object?> change in changes)
            {
                members[change.Key] = change.Value;
            }
            return JsonText.Of(members);
        }
    }
}
