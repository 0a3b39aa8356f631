#nullable enable
using System;
using System.Runtime.CompilerServices;
using System.Security.Cryptography;
using UnityEditor.AssetImporters;
using Object = UnityEngine.Object;

namespace HaptoFlow.Editor
{
    /// <summary>Lets the native library check .haptoflow files.</summary>
    internal static class ModelCheck
    {
        private static readonly ConditionalWeakTable<byte[], Answer> Known = new ConditionalWeakTable<byte[], Answer>();

        /// <summary>Null for a valid file. Each file is checked once.</summary>
        public static FileProblem? ProblemOf(byte[] file) => Known.GetValue(file, each => new Answer(each)).Problem;

        private sealed class Answer
        {
            public Answer(byte[] file)
            {
                try
                {
                    using HapticModel model = HapticModel.Open(file);
                }
                catch (HaptoFlowException refusal)
                {
                    Problem = FileProblem.Of(refusal, file);
                }
            }

            public FileProblem? Problem { get; }
        }
    }

    /// <summary>Why a model or a material file cannot be used here.</summary>
    /// <param name="Text">The problem and its remedy. Of a file that the native library could not be asked about, also
    /// what identifies it: its size and its SHA-256 checksum.</param>
    /// <param name="WasChecked">False where the native library could not be asked, so that the file may be
    /// good.</param>
    internal sealed record FileProblem(string Text, bool WasChecked)
    {
        public static FileProblem Of(HaptoFlowException refusal, byte[] file)
        {
            bool wasChecked = refusal.Status != HaptoFlowStatus.LibraryUnavailable &&
                refusal.Status != HaptoFlowStatus.LibraryMismatch;
            return new FileProblem(wasChecked ? refusal.Message : refusal.Message + Identity(file), wasChecked);
        }

        /// <summary>Logs the problem of an imported file: an error, or a warning where the file may be good.</summary>
        public void Log(AssetImportContext ctx, Object asset)
        {
            string message = $"HaptoFlow: {ctx.assetPath}: {Text}";
            if (WasChecked)
            {
                ctx.LogImportError(message, asset);
            }
            else
            {
                ctx.LogImportWarning(message, asset);
            }
        }

        private static string Identity(byte[] file)
        {
            using SHA256 hash = SHA256.Create();
            string sum = BitConverter.ToString(hash.ComputeHash(file)).Replace("-", "").ToLowerInvariant();
            return SummaryRow.Format(". The file was not checked; it has {0} bytes and the SHA-256 checksum {1}",
                file.Length, sum);
        }
    }
}
