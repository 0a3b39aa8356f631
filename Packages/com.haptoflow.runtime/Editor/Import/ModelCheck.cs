#nullable enable
using System;
using System.Runtime.CompilerServices;
using HaptoFlow.Model;

namespace HaptoFlow.Editor
{
    /// <summary>Checks the header of a .haptoflow file and the checksum of every part, without the native library.
    /// </summary>
    internal static class ModelCheck
    {
        private static readonly ConditionalWeakTable<byte[], string> KnownProblems =
            new ConditionalWeakTable<byte[], string>();

        /// <summary>The problem and its remedy; null for a valid file. Each file is checked once.</summary>
        public static string? ProblemOf(byte[] file)
        {
            string problem = KnownProblems.GetValue(file, each => Find(each) ?? "");
            return problem.Length > 0 ? problem : null;
        }

        private static string? Find(byte[] file)
        {
            try
            {
                ModelHeader.Read(file);
                return ProblemOfParts(file, JsonValue.Parse(ModelFile.HeaderText(file))["blobs"]);
            }
            catch (HaptoFlowException refusal)
            {
                return refusal.Message;
            }
            catch (FormatException error)
            {
                return "the JSON header: " + error.Message;
            }
        }

        private static string? ProblemOfParts(byte[] file, JsonValue parts)
        {
            foreach (JsonValue part in parts.AsArray())
            {
                double offset = part["offset"].AsNumber();
                double length = part["bytes"].AsNumber();
                string name = part["name"].AsText();
                if (!(offset >= 0.0 && length >= 0.0 && offset + length <= file.Length))
                {
                    return $"the part \"{name}\" lies outside the file: copy or download the file again";
                }
                uint checksum = Crc32.Of(file.AsSpan((int)offset, (int)length));
                if (!checksum.Equals((uint)part["crc32"].AsNumber()))
                {
                    return $"the part \"{name}\" does not match its checksum: copy or download the file again";
                }
            }
            return null;
        }
    }
}
