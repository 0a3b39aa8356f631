using System;
using System.Collections.Generic;
using System.IO;
using System.Linq;
using System.Reflection;
using Newtonsoft.Json.Linq;
using System.Text.RegularExpressions;
using HaptoFlow.Editor;
using HaptoFlow.Studies;
using HaptoFlow.Tests.Support;
using NUnit.Framework;
using UnityEditor.Overlays;
using UnityEngine;
using UnityShim;

namespace HaptoFlow.EditorTests
{
    /// <summary>Help buttons, menu and Package Manager lead to pages that exist: inside the package, or in a clone.
    /// </summary>
    public sealed class HelpTests
    {
        internal static readonly Assembly[] Assemblies =
        {
            typeof(HapticSurface).Assembly, typeof(MousePen).Assembly, typeof(InputActionTipForce).Assembly,
            typeof(MetaActionTipForce).Assembly, typeof(MaskingNoise).Assembly,
        };

        private static string folder = "";

        [SetUp]
        public void MakeFolder() => folder = Directory.CreateDirectory(
            Path.Combine(Path.GetTempPath(), $"haptoflow-help-{Guid.NewGuid():N}")).FullName;

        [TearDown]
        public void RemoveFolder()
        {
            HelpPages.FindPackage = null;
            EditorSession.PackageFolder = null;
            Directory.Delete(folder, true);
        }

        private static IEnumerable<Type> Components() => Assemblies.SelectMany(assembly => assembly.GetTypes())
            .Where(type => type.IsPublic && !type.IsAbstract &&
                (typeof(MonoBehaviour).IsAssignableFrom(type) || typeof(ScriptableObject).IsAssignableFrom(type)));

        [TestCaseSource(nameof(Components))]
        public void TheHelpOfAComponentLeadsToASectionOfAPage(Type component)
        {
            string? help = component.GetCustomAttribute<HelpPageAttribute>(false)?.Page;
            Assert.That(help, Is.Not.Null, component.Name + " has no [HelpPage]");
            string[] parts = help!.Split('#');
            IEnumerable<string> anchors = Regex.Matches(Page(parts[0]), "^#+ (.*)$", RegexOptions.Multiline)
                .Select(heading => AnchorOf(heading.Groups[1].Value));
            Assert.That(anchors.Count(anchor => anchor == parts[1]), Is.EqualTo(1), help);
        }

        [Test]
        public void HelpOpensTheSectionOfThePageInsideAnInstalledPackage()
        {
            string pages = InstalledPages("a folder");
            File.WriteAllText(Path.Combine(pages, "components.html"), "<h2>Haptic Surface</h2>");
            string? url = typeof(HapticSurface).GetCustomAttribute<HelpURLAttribute>(false)?.URL;
            Assert.That(url, Is.EqualTo(
                new Uri(Path.Combine(pages, "components.html")).AbsoluteUri + "#haptic-surface"));
            Assert.That(url, Does.StartWith("file:///").And.Contain("a%20folder").And.Contain("Documentation~/"));
        }

        [Test]
        public void InACloneHelpAndMenuOpenTheMarkdownOfTheRepository()
        {
            Install("clone", "Packages", "com.haptoflow.runtime");
            string pages = Directory.CreateDirectory(Path.Combine(folder, "clone", "Documentation~")).FullName;
            File.WriteAllText(Path.Combine(pages, "components.md"), "## Haptic Surface");
            File.WriteAllText(Path.Combine(pages, "index.md"), "# HaptoFlow");
            Assert.That(typeof(HapticSurface).GetCustomAttribute<HelpURLAttribute>(false)?.URL,
                Is.EqualTo(new Uri(Path.Combine(pages, "components.md")).AbsoluteUri));
            DocumentationMenu.Open();
            Assert.That(World.OpenedUrl, Is.EqualTo(new Uri(Path.Combine(pages, "index.md")).AbsoluteUri));
        }

        [Test]
        public void FromAGitUrlHelpOpensTheReadmeAndTheMenuSaysWhereThePagesAre()
        {
            string package = Install("project", "Library", "PackageCache", "com.haptoflow.runtime@0123456789");
            string readme = Path.Combine(package, "README.md");
            File.Copy(RepositoryFiles.In("Packages", "com.haptoflow.runtime", "README.md"), readme);
            Assert.That(File.ReadAllText(readme), Does.Contain("git URL"));
            Assert.That(typeof(HapticSurface).GetCustomAttribute<HelpURLAttribute>(false)?.URL,
                Is.EqualTo(new Uri(readme).AbsoluteUri));
            string? before = World.OpenedUrl;
            Log.Clear();
            DocumentationMenu.Open();
            Assert.That(World.OpenedUrl, Is.EqualTo(before));
            Assert.That(Log.Lines.Single().Text, Does.Match("git URL.*tarball.*clone"));
        }

        [Test]
        public void WithoutPagesOrEditorThereIsNoHelpAndNoError()
        {
            InstalledPages("empty");
            Assert.That(typeof(HapticSurface).GetCustomAttribute<HelpURLAttribute>(false)?.URL, Is.Empty);
            HelpPages.FindPackage = null;
            Assert.That(typeof(HapticSurface).GetCustomAttribute<HelpURLAttribute>(false)?.URL, Is.Empty);
        }

        [Test]
        public void PublishedPagesTakeThePlaceOfThoseInThePackage() => Assert.That(
            HelpPages.AddressOfPage("components.html#haptic-surface", "https://pages.example/"),
            Is.EqualTo("https://pages.example/components.html#haptic-surface"));

        [Test]
        public void TheMenuOpensTheFirstPage()
        {
            string pages = InstalledPages("menu");
            File.WriteAllText(Path.Combine(pages, "index.html"), "");
            DocumentationMenu.Open();
            Assert.That(World.OpenedUrl, Is.EqualTo(new Uri(Path.Combine(pages, "index.html")).AbsoluteUri));
        }

        private static string InstalledPages(string name)
        {
            return Directory.CreateDirectory(Path.Combine(Install(name), "Documentation~")).FullName;
        }

        private static string Install(params string[] place)
        {
            string package = Directory.CreateDirectory(Path.Combine(folder, Path.Combine(place))).FullName;
            EditorSession.PackageFolder = package;
            EditorLifecycle.Begin();
            return package;
        }

        private static string Page(string name) =>
            File.ReadAllText(RepositoryFiles.In("Documentation~", name.Replace(".html", ".md")));

        /// <summary>The anchor that Markdown renderers give to a heading.</summary>
        internal static string AnchorOf(string heading) =>
            Regex.Replace(heading.Trim().ToLowerInvariant(), "[^a-z0-9 -]", "").Replace(' ', '-');
    }
}
