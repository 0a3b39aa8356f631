#nullable enable
using System;
using UnityEngine;

namespace HaptoFlow.Tests
{
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
        public static HapticModelAsset Damaged() =>
            HapticModelAsset.Create(ModelBytes.Flipped(DefaultModel.Asset().File, 100));

        private static HapticModelAsset With(Func<string, string> change) =>
            HapticModelAsset.Create(ModelBytes.WithHeader(DefaultModel.Asset().File, header =>
            {
                string after = change(header);
                return after != header ? after : throw new InvalidOperationException("the header must change");
            }));
    }
}
