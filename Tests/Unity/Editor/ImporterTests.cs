#nullable enable
using System;
using System.Linq;
using NUnit.Framework;
using UnityEditor;
using UnityEditor.AssetImporters;
using UnityEngine.TestTools;

namespace HaptoFlow.EditorTests
{
    public sealed class ImporterTests : EditorTest
    {
        [TestCase("truncated", "get it again")]
        [TestCase("text", "not a .haptoflow file")]
        public void ADamagedFileBecomesAnAssetAndLogsItsProblem(string damage, string message)
        {
            LogAssert.ignoreFailingMessages = true;
            string path = Import(damage + ".haptoflow", Damaged(Model().File, damage));
            Assert.That(AssetDatabase.LoadAssetAtPath<HapticModelAsset>(path), Is.Not.Null);
            Assert.That(ImportErrors(path), Has.Length.EqualTo(1));
            Assert.That(ImportErrors(path)[0], Does.Contain(path).And.Contain(message));
        }

        [Test]
        public void AReplacedFileIsCheckedAgain()
        {
            LogAssert.ignoreFailingMessages = true;
            byte[] sound = Model().File;
            Import("model.haptoflow", Damaged(sound, "truncated"));
            string path = Import("model.haptoflow", sound);
            Assert.That(AssetDatabase.LoadAssetAtPath<HapticModelAsset>(path).Header.Labels, Has.Count.EqualTo(20));
            Assert.That(ImportErrors(path), Is.Empty);
        }

        private static byte[] Damaged(byte[] file, string damage) => damage == "truncated"
            ? ModelBytes.Truncated(file, file.Length - 1000)
            : System.Text.Encoding.ASCII.GetBytes("this is no model, but a text of more than 32 bytes");

        private static string[] ImportErrors(string path)
        {
            ImportLog? log = AssetImporter.GetImportLog(path);
            return log == null
                ? Array.Empty<string>()
                : log.logEntries.Where(entry => (entry.flags & ImportLogFlags.Error) != 0)
                    .Select(entry => entry.message).ToArray();
        }
    }
}
