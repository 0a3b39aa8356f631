#nullable enable
using System.Runtime.CompilerServices;

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
}
