#nullable enable
using System;
using System.Collections.Generic;
using System.Linq;

namespace HaptoFlow.Model
{
    /// <summary>Writes material files: from a label of a model, and copies of materials with changes.</summary>
    internal static class MaterialText
    {
        private static readonly string[] LabelKeys =
        {
            "name", "category", "level_exponents", "frequency_exponent", "periodic", "wavelength_metres",
            "stiffness_newtons_per_metre", "friction_coefficient", "impact", "level", "tone", "level_offset_db",
            "stick_slip", "rib_wander", "impulse_gain",
        };

        /// <summary>The material file of a label. It has no seeds: if the model needs seeds, its own apply.</summary>
        /// <param name="file">The whole .haptoflow file.</param>
        /// <exception cref="HaptoFlowException">The bytes are not a model, or it has no such label.</exception>
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

        /// <summary>A copy of a material with some members replaced.</summary>
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
