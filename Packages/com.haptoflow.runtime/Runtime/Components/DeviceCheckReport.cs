#nullable enable
using System;
using System.Collections.Generic;
using System.IO;
using System.Linq;
using System.Net;
using System.Text;
using HaptoFlow.Files;
using HaptoFlow.Model;

namespace HaptoFlow.DeviceCheck
{
    /// <summary>The lines of a device check, and the two files that are shared: JSON and a page. They hold nothing
    /// about a person. Any thread that may access files.</summary>
    internal sealed class DeviceCheckReport
    {
        public const string JsonName = "device-check.json";
        public const string PageName = "device-check.html";

        public DeviceCheckReport(IReadOnlyList<(string Name, string Value)> environment) => Environment = environment;

        public IReadOnlyList<(string Name, string Value)> Environment { get; }

        public List<CheckLine> Lines { get; } = new List<CheckLine>();

        public static string WhereToSend => WhereToSendTo(HelpPages.Issues);

        internal static string WhereToSendTo(string address) => address.Length > 0
            ? $"Please attach both files to a new issue at {address}."
            : "Please attach both files to a new issue of the repository that you have the package from; the package " +
                "itself has no published address yet.";

        /// <summary>For example "21 passed, 1 failed, 4 skipped, 0 not answered".</summary>
        public string Summary => $"{Count(CheckState.Passed)} passed, {Count(CheckState.Failed)} failed, " +
            $"{Count(CheckState.Skipped)} skipped, {Count(CheckState.Asked)} not answered";

        /// <summary>Writes both files, each as a whole or not at all.</summary>
        /// <returns>The path of the page.</returns>
        /// <exception cref="IOException">A file cannot be written.</exception>
        /// <exception cref="UnauthorizedAccessException">A file cannot be written.</exception>
        public string Write(string folder)
        {
            WholeFile.Write(Path.Combine(folder, JsonName), Json());
            string page = Path.Combine(folder, PageName);
            WholeFile.Write(page, Page());
            return page;
        }

        public string Json() => JsonText.Of(new Dictionary<string, object?>
        {
            ["format"] = "haptoflow-device-check",
            ["version"] = 1,
            ["environment"] = Environment.ToDictionary(each => each.Name, each => (object?)each.Value),
            ["lines"] = Lines.Select(line => new Dictionary<string, object?>
            {
                ["group"] = line.Group,
                ["name"] = line.Name,
                ["state"] = line.State.ToString().ToLowerInvariant(),
                ["measured"] = line.Measured,
                ["remedy"] = line.Remedy,
            }).ToArray(),
        });

        public string Page()
        {
            var page = new StringBuilder();
            page.Append("<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">" +
                "<meta name=\"viewport\" content=\"width=device-width\"><title>HaptoFlow device check</title><style>" +
                "body{font:16px/1.4 sans-serif;max-width:60em;margin:1em auto;padding:0 1em}" +
                "table{border-collapse:collapse;width:100%}td,th{border:1px solid #bbb;padding:.3em;text-align:left;" +
                "vertical-align:top}.failed{background:#fdd}.passed{background:#dfd}</style></head><body>\n" +
                "<h1>HaptoFlow device check</h1>\n<p>");
            page.Append(Escaped(Summary)).Append(".</p>\n<p>").Append(Escaped(WhereToSend)).Append("</p>\n<table>\n");
            foreach ((string name, string value) in Environment)
            {
                page.Append($"<tr><th>{Escaped(name)}</th><td>{Escaped(value)}</td></tr>\n");
            }
            page.Append("</table>\n");
            foreach (IGrouping<string, CheckLine> group in Lines.GroupBy(line => line.Group))
            {
                page.Append($"<h2>{Escaped(group.Key)}</h2>\n<table>\n" +
                    "<tr><th>line</th><th>state</th><th>measured</th><th>what to do</th></tr>\n");
                foreach (CheckLine line in group)
                {
                    string state = line.State == CheckState.Asked ? "not answered" : Escaped(line.State.ToString());
                    page.Append($"<tr class=\"{line.State.ToString().ToLowerInvariant()}\">" +
                        $"<td>{Escaped(line.Name)}</td><td>{state.ToLowerInvariant()}</td>" +
                        $"<td>{Escaped(line.Measured)}</td><td>{Escaped(line.Remedy)}</td></tr>\n");
                }
                page.Append("</table>\n");
            }
            return page.Append("</body></html>\n").ToString();
        }

        private int Count(CheckState state) => Lines.Count(line => line.State == state);

        private static string Escaped(string text) => WebUtility.HtmlEncode(text);
    }

    internal enum CheckState
    {
        /// <summary>Measured, and as it should be.</summary>
        Passed,

        /// <summary>Measured or answered, and not as it should be.</summary>
        Failed,

        /// <summary>Not measured here: the text says why.</summary>
        Skipped,

        /// <summary>A question that was asked and not answered.</summary>
        Asked,
    }

    /// <summary>One line of the device check.</summary>
    /// <param name="Measured">What was measured, with units; for a skipped line, why nothing was.</param>
    /// <param name="Remedy">What to do; empty for lines that did not fail.</param>
    internal sealed record CheckLine(string Group, string Name, CheckState State, string Measured, string Remedy)
    {
        public static CheckLine Of(string group, string name, bool passed, string measured, string remedy) =>
            new CheckLine(group, name, passed ? CheckState.Passed : CheckState.Failed, measured, passed ? "" : remedy);

        public static CheckLine Skipped(string group, string name, string why) =>
            new CheckLine(group, name, CheckState.Skipped, why, "");

        public static CheckLine Unanswered(string group, string name) =>
            new CheckLine(group, name, CheckState.Asked, "not answered", "");
    }
}
