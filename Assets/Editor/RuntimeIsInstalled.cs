#nullable enable
using System.IO;
using UnityEditor;
using UnityEngine;

namespace HaptoFlow.ProjectCheck
{
    /// <summary>Says in the console what to do where npm has not brought ONNX Runtime, without which the Package Manager
    /// resolves no package at all. Its assembly refers to no other, so that it compiles even then.</summary>
    internal static class RuntimeIsInstalled
    {
        // Packages/manifest.json names this folder.
        private const string Manifest = "node_modules/com.github.asus4.onnxruntime/package.json";

        // The editor's working folder is that of the project.
        [InitializeOnLoadMethod]
        private static void CheckThisProject() => Check(Directory.GetCurrentDirectory());

        /// <summary>Logs an error if a project's folder has no ONNX Runtime in node_modules.</summary>
        internal static void Check(string project)
        {
            if (!File.Exists(Path.Combine(project, Manifest)))
            {
                Debug.LogError("HaptoFlow: ONNX Runtime is missing, so HaptoFlow did not load. Close Unity, run " +
                    "\"npm ci\" in " + project + " (it needs Node.js 18.15 or newer from nodejs.org), then open the " +
                    "project again.");
            }
        }
    }
}
