using System;
using System.IO;
using HaptoFlow.EditorTests;
using HaptoFlow.Model;
using HaptoFlow.Tests.Support;

namespace HaptoFlow.PreviewTests
{
    /// <summary>The default model and changed copies of it.</summary>
    internal static class ModelFiles
    {
        public static byte[] Default { get; } = File.ReadAllBytes(RepositoryFiles.DefaultModel);

        public static byte[] Damaged()
        {
            byte[] file = (byte[])Default.Clone();
            file[100] ^= 1;
            return file;
        }

        /// <summary>The header of the default model after a change of its text.</summary>
        public static ModelHeader HeaderWith(Func<string, string> change) =>
            ModelHeader.Read(ModelBytes.WithHeader(Default, change));
    }
}
