#nullable enable
using System.IO;
using System.Linq;
using System.Text.RegularExpressions;
using System.Xml.Linq;
using UnityEditor;
using UnityEditor.Android;
using UnityEngine;

namespace HaptoFlow.Editor
{
    /// <summary>Adds the entry of Meta's experimental features to the manifest of an Android player whose scenes play
    /// parametric haptics: without it the headset refuses them. Only the author's <see
    /// cref="ControllerParametricOutput.UseExperimentalFeature"/> causes it, because Meta's store does not accept such an
    /// application.</summary>
    /// <remarks>Reads the files of the scenes and of their prefabs, since Unity does not process scenes again that have
    /// not changed since the last build.</remarks>
    internal sealed class ParametricManifestEntry : IPostGenerateGradleAndroidProject
    {
        private const string Feature = "com.oculus.experimental.enabled";
        private static readonly XNamespace Android = "http://schemas.android.com/apk/res/android";

        // As Unity writes it into a component, or into a scene that overrides a prefab.
        private static readonly Regex IsUsed =
            new Regex(@"useExperimentalFeature(: 1\b|\s+value: 1\b)", RegexOptions.CultureInvariant);

        // Meta's SDK writes the manifest at 99999, and removes the entry while its own setting is off.
        public int callbackOrder => 100000;

        public void OnPostGenerateGradleAndroidProject(string path)
        {
            string? user = EditorBuildSettings.scenes
                .Where(scene => scene.enabled)
                .SelectMany(scene => AssetDatabase.GetDependencies(scene.path, true))
                .FirstOrDefault(PlaysParametric);
            if (user != null && AddEntry(Path.Combine(path, "src", "main", "AndroidManifest.xml")))
            {
                Debug.Log($"HaptoFlow: {user} plays parametric haptics, so {Feature} was added to the manifest. Meta's " +
                    "store does not accept this application, and experimental features must be enabled on the headset.");
            }
        }

        private static bool PlaysParametric(string asset)
        {
            string extension = Path.GetExtension(asset);
            string file = FileUtil.GetPhysicalPath(asset);
            return (extension == ".unity" || extension == ".prefab") && File.Exists(file) &&
                IsUsed.IsMatch(File.ReadAllText(file));
        }

        private static bool AddEntry(string file)
        {
            if (!File.Exists(file))
            {
                Debug.LogWarning($"HaptoFlow: this build has no {file}: add <uses-feature android:name=\"{Feature}\" " +
                    "android:required=\"true\"/> to its manifest, or parametric haptics stay silent.");
                return false;
            }
            XDocument manifest = XDocument.Load(file);
            XElement root = manifest.Root!;
            bool has = root.Elements("uses-feature").Any(each => (string?)each.Attribute(Android + "name") == Feature);
            if (!has)
            {
                root.Add(new XElement("uses-feature",
                    new XAttribute(Android + "name", Feature), new XAttribute(Android + "required", "true")));
                manifest.Save(file);
            }
            return !has;
        }
    }
}
