using System;
using System.IO;
using System.Linq;
using System.Security.Cryptography;
using System.Text;
using HaptoFlow.Editor;
using HaptoFlow.EditorTests;
using HaptoFlow.Tests.Support;
using NUnit.Framework;
using UnityEditor;
using UnityEditor.AssetImporters;
using UnityEngine;

namespace HaptoFlow.MissingLibraryTests
{
    public sealed class MissingLibraryImportTests : EditorTest
    {
        private static readonly byte[] Material =
            File.ReadAllBytes(RepositoryFiles.In("Tests", "Golden", "material", "denim.haptomaterial"));

        [Test]
        public void AModelIsImportedAndItsSizeItsChecksumAndTheReasonAreShown()
        {
            byte[] file = Model().File;
            string path = Import("unchecked.haptoflow", file);
            var asset = AssetDatabase.LoadAssetAtPath<HapticModelAsset>(path);
            Assert.That(asset.File.AsSpan().SequenceEqual(file), Is.True);
            AssertIdentified(OnlyWarning(path), file);
            AssertIdentified(ModelSummary.Of(asset).Problem, file);
        }

        [Test]
        public void AMaterialFileIsKeptForPlayersThatHaveTheLibrary()
        {
            string path = Import("unchecked.haptomaterial", Material);
            var asset = AssetDatabase.LoadAssetAtPath<HapticMaterial>(path);
            Assert.That(asset.Learnt, Is.EqualTo(Encoding.UTF8.GetString(Material)));
            AssertIdentified(OnlyWarning(path), Material);
            AssertIdentified(MaterialSummary.Of(asset.Learnt, Model()).Problem, Material);
        }

        [Test]
        public void AReliefIsNotFeltAndTheReasonIsSaidOnce()
        {
            var relief = ScriptableObject.CreateInstance<HapticRelief>();
            relief.name = "Waves";
            relief.SetHeights(2, 1, new[] { 0f, 1f });
            UnityShim.Log.Clear();
            Assert.That((relief.Number, relief.Number), Is.EqualTo((0u, 0u)));
            Assert.That(UnityShim.Log.Lines.Single().Text, Does.Match("Waves is not felt: .*native library.*install"));
        }

        [Test]
        public void AClipIsKeptForPlayersThatHaveTheLibraryAndIsNotFeltHere()
        {
            byte[] file = Encoding.UTF8.GetBytes("{\"perceptions\":[]}");
            string path = Import("unchecked.hjif", file);
            var clip = AssetDatabase.LoadAssetAtPath<HapticClip>(path);
            Assert.That(clip.File, Is.EqualTo(file));
            AssertIdentified(OnlyWarning(path), file);
            Assert.That(clip.Problem, Does.Contain("native library"));
            UnityShim.Log.Clear();
            Assert.That((clip.Content, clip.Content), Is.EqualTo(((HapticClipFile?)null, (HapticClipFile?)null)));
            Assert.That(UnityShim.Log.Lines.Single().Text, Does.Match("unchecked is not felt: .*native library.*install"));
        }

        private static string OnlyWarning(string path)
        {
            ImportLog.ImportLogEntry entry = AssetImporter.GetImportLog(path)!.logEntries.Single();
            Assert.That(entry.flags, Is.EqualTo(ImportLogFlags.Warning));
            Assert.That(entry.message, Does.Contain(path));
            return entry.message;
        }

        private static void AssertIdentified(string? shown, byte[] file)
        {
            using SHA256 hash = SHA256.Create();
            string sum = string.Concat(hash.ComputeHash(file).Select(value => value.ToString("x2")));
            Assert.That(shown, Does.Contain("native library").And.Contain("install the packages")
                .And.Contain(file.Length + " bytes").And.Contain(sum));
        }
    }
}
