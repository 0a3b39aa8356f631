#nullable enable
using System;
using System.IO;
using UnityEngine;

namespace HaptoFlow
{
    /// <summary>Where the help buttons lead: to the pages on disk, until they are published.</summary>
    internal static class HelpPages
    {
        /// <summary>Address of the published pages, with a slash at its end. While it is empty, help opens the pages
        /// on disk. A release that publishes them changes this constant only.</summary>
        public const string Published = "";

        /// <summary>The page with a section for each component; append the section's anchor.</summary>
        public const string Components = "components.html#";

        /// <summary>The page with a section for each kind of output; append the section's anchor.</summary>
        public const string Outputs = "effects-and-outputs.html#";

        public const string Index = "index.html";

        /// <summary>Address of the issue tracker, for reports of the device check. While it is empty, none is published.
        /// A release that publishes it changes this constant only.</summary>
        public const string Issues = "";

        // In a clone the pages lie beside Packages. A git URL brings none.
        private static readonly string[] Folders = { "Documentation~", Path.Combine("..", "..", "Documentation~") };

        /// <summary>Finds the package's folder; set by the editor. A player has no pages.</summary>
        internal static Func<string?>? FindPackage { get; set; }

        /// <summary>The address of a page, or of the package's README where there are no pages: Unity would open its own
        /// manual for an empty address. Empty in a player.</summary>
        /// <param name="page">Its name, with an anchor or without: "components.html#haptic-surface".</param>
        public static string AddressOf(string page)
        {
            string address = AddressOfPage(page, Published);
            return address.Length == 0 && FindPackage?.Invoke() is { } package
                ? AddressOfFile(Path.Combine(package, "README.md"))
                : address;
        }

        /// <summary>The address of a page: on the web once pages are published, else of a file. Empty where there is none.
        /// </summary>
        internal static string AddressOfPage(string page, string published = Published)
        {
            if (published.Length > 0)
            {
                return published + page;
            }
            if (FindPackage?.Invoke() is { } package)
            {
                string[] parts = page.Split('#');
                foreach (string folder in Folders)
                {
                    string file = Path.Combine(package, folder, parts[0]);
                    string address = AddressOfFile(file);
                    if (address.Length > 0)
                    {
                        return address + (parts.Length > 1 ? "#" + parts[1] : "");
                    }
                    // Packing makes the HTML; a clone has Markdown, in which no anchor opens.
                    address = AddressOfFile(Path.ChangeExtension(file, ".md"));
                    if (address.Length > 0)
                    {
                        return address;
                    }
                }
            }
            return "";
        }

        private static string AddressOfFile(string file) => File.Exists(file) ? new Uri(file).AbsoluteUri : "";
    }

    /// <summary>Names the page that the help button of a component or asset opens. Unlike Unity's own attribute it takes
    /// a page's name, and finds the address when the button is drawn.</summary>
    [AttributeUsage(AttributeTargets.Class, AllowMultiple = false)]
    internal sealed class HelpPageAttribute : HelpURLAttribute
    {
        /// <param name="page">As for <see cref="HelpPages.AddressOf(string)"/>.</param>
        public HelpPageAttribute(string page)
            : base(HelpPages.AddressOf(page)) => Page = page;

        public string Page { get; }
    }
}
