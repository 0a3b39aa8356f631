#nullable enable
using System;
using System.Buffers.Binary;
using System.Text;
using UnityEngine;

namespace HaptoFlow.Tests
{
    /// <summary>The model of the package.</summary>
    internal static class DefaultModel
    {
#if HAPTOFLOW_OUTSIDE_UNITY
        private static byte[]? file;

        public static HapticModelAsset Asset() => HapticModelAsset.Create(
            file ??= System.IO.File.ReadAllBytes(Support.RepositoryFiles.DefaultModel));
#elif UNITY_EDITOR
        public static HapticModelAsset Asset() => UnityEditor.AssetDatabase.LoadAssetAtPath<HapticModelAsset>(
            "Packages/com.haptoflow.runtime/Runtime/Models/default.haptoflow");
#else
        public static HapticModelAsset Asset() => HaptoFlowSettings.Active.Model!;
#endif
    }

    /// <summary>The package's model with a modified header of the same length and valid checksums.</summary>
    internal static class EditedModel
    {
        private const int HeaderStart = 32;

        /// <summary>A model in which every label has another label's sound.</summary>
        public static HapticModelAsset WithLabelsReversed() => With(header =>
        {
            string[] parts = header.Split("\"embedding_row\":");
            int count = parts.Length - 1;
            for (int label = 0; label < count; ++label)
            {
                string rest = parts[label + 1].TrimStart().TrimStart("0123456789".ToCharArray());
                parts[label + 1] = $" {count - 1 - label}{rest}";
            }
            return string.Join("\"embedding_row\":", parts).Replace("\":  ", "\": ");
        });

        /// <summary>A model of another space: materials learnt for the package's model are refused.</summary>
        public static HapticModelAsset OfAnotherSpace() => With(header => header.Replace("\"draft\"", "\"rough\"").Replace("\"draft.", "\"rough."));

        /// <summary>A model whose parts do not match their checksums.</summary>
        public static HapticModelAsset Damaged()
        {
            byte[] file = (byte[])DefaultModel.Asset().File.Clone();
            file[100] ^= 1;
            return HapticModelAsset.Create(file);
        }

        private static HapticModelAsset With(Func<string, string> change)
        {
            byte[] file = (byte[])DefaultModel.Asset().File.Clone();
            int length = BinaryPrimitives.ReadInt32LittleEndian(file.AsSpan(12));
            string before = Encoding.UTF8.GetString(file, HeaderStart, length);
            string after = change(before.TrimEnd(' '));
            byte[] text = Encoding.UTF8.GetBytes(after.PadRight(length));
            if (text.Length != length || after == before.TrimEnd(' '))
            {
                throw new InvalidOperationException("the header must change and keep its length");
            }
            text.CopyTo(file, HeaderStart);
            BinaryPrimitives.WriteUInt32LittleEndian(file.AsSpan(24), Crc32.Of(text));
            BinaryPrimitives.WriteUInt32LittleEndian(file.AsSpan(28), Crc32.Of(file.AsSpan(0, 28)));
            return HapticModelAsset.Create(file);
        }
    }
}
