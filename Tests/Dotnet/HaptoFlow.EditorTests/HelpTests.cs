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

namespace HaptoFlow.EditorTests
{
    /// <summary>The help buttons of the Inspectors and the links of the Package Manager lead to existing pages.
    /// </summary>
    public sealed class HelpTests
    {
        private static readonly Assembly[] Assemblies =
        {
            typeof(HapticSurface).Assembly, typeof(MousePen).Assembly, typeof(InputActionTipForce).Assembly,
            typeof(MaskingNoise).Assembly,
        };

        private static IEnumerable<Type> Components() => Assemblies.SelectMany(assembly => assembly.GetTypes())
            .Where(type => type.IsPublic && !type.IsAbstract &&
                (typeof(MonoBehaviour).IsAssignableFrom(type) || typeof(ScriptableObject).IsAssignableFrom(type)));

        [Test]
        public void TheAssembliesContainComponents() => Assert.That(Components().Count(), Is.GreaterThanOrEqualTo(11));

        [TestCaseSource(nameof(Components))]
        public void TheHelpOfAComponentLeadsToASectionOfAPage(Type component)
        {
            string? url = component.GetCustomAttribute<HelpURLAttribute>(false)?.URL;
            Assert.That(url, Does.StartWith(HelpPages.Home), component.Name + " has no [HelpURL]");
            string[] parts = url!.Substring(HelpPages.Home.Length).Split('#');
            string page = Page(parts[0]);
            IEnumerable<string> anchors = Regex.Matches(page, "^#+ (.*)$", RegexOptions.Multiline)
                .Select(heading => AnchorOf(heading.Groups[1].Value));
            Assert.That(anchors.Count(anchor => anchor == parts[1]), Is.EqualTo(1), url);
        }

        [Test]
        public void EveryComponentHasItsOwnHelp() => Assert.That(
            Components().Select(type => type.GetCustomAttribute<HelpURLAttribute>(false)?.URL), Is.Unique);

        [Test]
        public void ThePackageManagersLinksLeadToExistingPages()
        {
            JObject manifest = JObject.Parse(File.ReadAllText(
                RepositoryFiles.In("Packages", "com.haptoflow.runtime", "package.json")));
            var documentation = (string?)manifest["documentationUrl"];
            var changes = (string?)manifest["changelogUrl"];
            Assert.That(documentation, Is.EqualTo(HelpPages.Home + "index.html"));
            Assert.That(changes, Is.EqualTo(HelpPages.Home + "changelog.html"));
            Assert.That(Page("index.html"), Does.Contain("](installation.md)").And.Contain("](first-scene.md)"));
        }

        [Test]
        public void TheFirstPageLeadsToEveryPage()
        {
            string index = Page("index.html");
            string[] pages = Directory.GetFiles(RepositoryFiles.In("Documentation~"), "*.md")
                .Select(path => Path.GetFileName(path)!).Where(name => name != "index.md").ToArray();
            Assert.That(pages.Where(name => !index.Contains($"]({name})")), Is.Empty);
        }

        [Test]
        public void TheOverlayOfSurfacesShowsByDefault() => Assert.That(
            typeof(SurfaceOverlay).GetCustomAttribute<OverlayAttribute>()!.defaultDisplay, Is.True);

        private static string Page(string name) =>
            File.ReadAllText(RepositoryFiles.In("Documentation~", name.Replace(".html", ".md")));

        /// <summary>The anchor that Markdown renderers give to a heading.</summary>
        private static string AnchorOf(string heading) =>
            Regex.Replace(heading.Trim().ToLowerInvariant(), "[^a-z0-9 -]", "").Replace(' ', '-');
    }
}
