using System.Collections.Generic;
using System.Globalization;
using System.IO;
using System.Linq;
using System.Text.RegularExpressions;

namespace HaptoFlow.Tests.Support
{
    /// <summary>A prefab or a scene in YAML, read as a list of objects with their fields. Lists and nested values are
    /// fields of the object that contains them.</summary>
    internal sealed class PrefabFile
    {
        private readonly Dictionary<string, PrefabObject> objects;

        public PrefabFile(string path) =>
            objects = Regex.Split(File.ReadAllText(path), "^--- ", RegexOptions.Multiline).Skip(1)
                .Select(text => new PrefabObject(text)).ToDictionary(each => each.Anchor);

        public PrefabObject this[string anchor] => objects[anchor];

        public IEnumerable<PrefabObject> Objects => objects.Values;

        public PrefabObject Root => objects.Values.Single(each => each.Type == "Transform" &&
            PrefabObject.Reference(each["m_Father"]) == "0");

        /// <summary>The path of the game object of a component, for example "Mouse Pen/Body".</summary>
        public string PathOf(PrefabObject transform)
        {
            string name = this[PrefabObject.Reference(transform["m_GameObject"])]["m_Name"];
            string father = PrefabObject.Reference(transform["m_Father"]);
            return father == "0" ? name : PathOf(this[father]) + "/" + name;
        }

        /// <summary>The components of the game object of a transform, in order.</summary>
        public IReadOnlyList<PrefabObject> ComponentsOf(PrefabObject transform) =>
            this[PrefabObject.Reference(transform["m_GameObject"])].List("m_Component").Select(each => this[each])
                .ToArray();
    }

    /// <summary>An object of a prefab.</summary>
    internal sealed class PrefabObject
    {
        private readonly Dictionary<string, string> fields = new Dictionary<string, string>();
        private readonly Dictionary<string, List<string>> lists = new Dictionary<string, List<string>>();

        public PrefabObject(string text)
        {
            string[] lines = text.Split('\n');
            Anchor = Regex.Match(lines[0], @"&(\d+)").Groups[1].Value;
            IsStripped = lines[0].EndsWith(" stripped");
            Type = lines[1].TrimEnd(':');
            string last = "";
            foreach (string line in lines.Skip(2))
            {
                Match field = Regex.Match(line, @"^  (\w[\w ]*): ?(.*)$");
                Match item = Regex.Match(line, @"^  - .*fileID: (\d+)");
                Match nested = Regex.Match(line, @"^    (\w+): ?(.*)$");
                if (field.Success)
                {
                    last = field.Groups[1].Value;
                    fields[last] = field.Groups[2].Value;
                    lists[last] = new List<string>();
                }
                else if (item.Success)
                {
                    lists[last].Add(item.Groups[1].Value);
                }
                else if (nested.Success)
                {
                    fields[last + "." + nested.Groups[1].Value] = nested.Groups[2].Value;
                }
            }
        }

        public string Anchor { get; }

        /// <summary>The type of the object, for example "Transform" or "MonoBehaviour".</summary>
        public string Type { get; }

        /// <summary>Whether the object stands for one of a prefab's instance, and has no values of its own.</summary>
        public bool IsStripped { get; }

        public string this[string name] => fields[name];

        /// <summary>The fields that the script declares, which follow Unity's own ones.</summary>
        public IEnumerable<string> ScriptFields => fields.Keys.SkipWhile(name => name != "m_EditorClassIdentifier")
            .Skip(1).Where(name => !name.Contains('.'));

        /// <summary>The fields inside a field.</summary>
        public IEnumerable<string> NestedFields(string name) => fields.Keys
            .Where(key => key.StartsWith(name + ".")).Select(key => key.Substring(name.Length + 1));

        public IReadOnlyList<string> List(string name) => lists[name];

        public static string Reference(string value) => Regex.Match(value, @"fileID: (\d+)").Groups[1].Value;

        public static float[] Numbers(string value) => Regex.Matches(value, @"\w: ([-0-9.e]+)")
            .Select(match => float.Parse(match.Groups[1].Value, CultureInfo.InvariantCulture)).ToArray();
    }
}
