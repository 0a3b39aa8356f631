#nullable enable
using System;
using System.IO;

namespace HaptoFlow
{
    /// <summary>Where the help buttons lead: to the pages inside the package, until they are published.</summary>
    internal static class HelpPages
    {
        /// <summary>Address of the published pages, with a slash at its end. While it is empty, help opens the pages
        /// inside the package. A release that publishes them changes this constant only.</summary>
        public const string Published = "";

        /// <summary>The page with a section for each component; append the section's anchor.</summary>
        public const string Components = "components.html#";

        /// <summary>The page with a section for each kind of output; append the section's anchor.</summary>
        public const string Outputs = "effects-and-outputs.html#";

        /// <summary>The first page.</summary>
        public const string Index = "index.html";

        /// <summary>Address of the issue tracker, for reports of the device check. While it is empty, none is published.
        /// A release that publishes it changes this constant only.</summary>
        public const string Issues = "";

        /// <summary>Finds the folder that holds the package's pages; set by the editor. A player has no pages.</summary>
        internal static Func<string?>? FindFolder { get; set; }

        /// <summary>The address of a page: on the web once pages are published, else of a file in the package. Empty where
        /// there are none, as in a player.</summary>
        /// <param name="page">Its name, with an anchor or without: "components.html#haptic-surface".</param>
        public static string AddressOf(string page) => AddressOf(page, Published);

        internal static string AddressOf(string page, string published)
        {
            if (published.Length > 0)
            {
                return published + page;
            }
            string[] parts = page.Split('#');
            string file = Path.Combine(FindFolder?.Invoke() ?? "", parts[0]);
            if (File.Exists(file))
            {
                return new Uri(file).AbsoluteUri + (parts.Length > 1 ? "#" + parts[1] : "");
            }
            // Packing makes the HTML; a package that is used from its sources has Markdown, in which no anchor opens.
            string source = Path.ChangeExtension(file, ".md");
            return File.Exists(source) ? new Uri(source).AbsoluteUri : "";
        }
    }
}
