using System;
using System.Collections.Generic;
using System.Globalization;
using System.IO;
using System.Linq;
using System.Reflection;
using System.Text.RegularExpressions;
using UnityEngine;
using Object = UnityEngine.Object;

namespace HaptoFlow.Tests.Support
{
    /// <summary>Makes the objects of a scene or prefab file, with those of its prefabs. A field of a script that the
    /// class does not have is an error. References to assets stay empty.</summary>
    internal sealed class ProjectScene
    {
        private static readonly string[] Unseen = { "OcclusionCullingSettings", "RenderSettings", "LightmapSettings",
            "NavMeshSettings", "SceneRoots" };
        private static readonly Lazy<Dictionary<string, string>> Paths = new Lazy<Dictionary<string, string>>(FindPaths);

        private static readonly MethodInfo AddAny =
            typeof(GameObject).GetMethod(nameof(GameObject.AddComponent), Type.EmptyTypes)!;

        private readonly Dictionary<string, Object> made = new Dictionary<string, Object>();
        private readonly List<GameObject> owners = new List<GameObject>();

        private ProjectScene()
        {
        }

        /// <summary>The objects, each of which has to be destroyed.</summary>
        public IReadOnlyList<GameObject> Owners => owners;

        /// <summary>Those without a parent.</summary>
        public IEnumerable<GameObject> Roots => owners.Where(owner => owner.transform.parent == null);

        /// <summary>Makes the objects of a scene in Assets and wakes them.</summary>
        public static ProjectScene Open(string name) => Load(RepositoryFiles.In("Assets", name));

        /// <summary>Makes the objects of a file and wakes them.</summary>
        public static ProjectScene Load(string path)
        {
            var scene = new ProjectScene();
            scene.Add(new PrefabFile(path), "");
            scene.owners.ForEach(owner => owner.SetActive(true));
            return scene;
        }

        /// <summary>The object or component at an anchor of the scene file.</summary>
        public Object this[string anchor] => made[anchor];

        private void Add(PrefabFile file, string prefix)
        {
            foreach (PrefabObject instance in file.Objects.Where(each => each.Type == "PrefabInstance"))
            {
                string source = instance["m_SourcePrefab"];
                Add(new PrefabFile(Paths.Value[GuidIn(source)]), prefix + instance.Anchor + "/");
            }
            foreach (PrefabObject written in file.Objects.Where(each => each.IsStripped))
            {
                string anchor = PrefabObject.Reference(written["m_CorrespondingSourceObject"]);
                made[prefix + written.Anchor] = made[PrefabObject.Reference(written["m_PrefabInstance"]) + "/" + anchor];
            }
            PrefabObject[] own = file.Objects.Where(each => !each.IsStripped && each.Type != "PrefabInstance").ToArray();
            foreach (PrefabObject written in own.Where(each => each.Type == "GameObject"))
            {
                var owner = new GameObject(written["m_Name"]) { tag = written["m_TagString"] };
                // Inactive until all is complete, as while Unity loads a scene.
                owner.SetActive(false);
                owners.Add(owner);
                made[prefix + written.Anchor] = owner;
                foreach (PrefabObject component in written.List("m_Component").Select(each => file[each]))
                {
                    AddComponent(owner, component, prefix);
                }
            }
            foreach (PrefabObject written in own.Where(each => made.ContainsKey(prefix + each.Anchor)))
            {
                Fill(made[prefix + written.Anchor], written, prefix);
            }
            foreach (PrefabObject instance in file.Objects.Where(each => each.Type == "PrefabInstance"))
            {
                string parent = PrefabObject.Reference(instance["m_Modification.m_TransformParent"]);
                if (parent != "0")
                {
                    var root = (Transform)made[prefix + instance.Anchor + "/101"];
                    root.SetParent((Transform)made[prefix + parent], false);
                }
            }
        }

        private void AddComponent(GameObject owner, PrefabObject written, string prefix)
        {
            if (written.Type == "Transform")
            {
                made[prefix + written.Anchor] = owner.transform;
            }
            else if (!Unseen.Contains(written.Type))
            {
                string name = written.Type == "MonoBehaviour"
                    ? Path.GetFileNameWithoutExtension(Paths.Value[GuidIn(written["m_Script"])])
                    : written.Type;
                Type type = AppDomain.CurrentDomain.GetAssemblies().SelectMany(each => each.GetTypes())
                    .First(each => each.Name == name && typeof(Component).IsAssignableFrom(each));
                // A component that another one requires is there already.
                var present = new List<Component>();
                owner.transform.GetComponents(present);
                Component? before = present.FirstOrDefault(each => each.GetType() == type && !made.ContainsValue(each));
                made[prefix + written.Anchor] = before ?? (Component)AddAny.MakeGenericMethod(type).Invoke(owner, null)!;
            }
        }

        private void Fill(Object target, PrefabObject written, string prefix)
        {
            switch (target)
            {
                case Transform place:
                    place.localPosition = Vector(written["m_LocalPosition"]);
                    float[] turn = PrefabObject.Numbers(written["m_LocalRotation"]);
                    place.localRotation = new Quaternion(turn[0], turn[1], turn[2], turn[3]);
                    place.localScale = Vector(written["m_LocalScale"]);
                    string father = PrefabObject.Reference(written["m_Father"]);
                    if (father != "0")
                    {
                        place.SetParent((Transform)made[prefix + father], false);
                    }
                    break;
                case Camera camera:
                    camera.clearFlags = (CameraClearFlags)int.Parse(written["m_ClearFlags"]);
                    camera.backgroundColor = (Color)Parsed(written["m_BackGroundColor"], typeof(Color));
                    camera.nearClipPlane = Number(written["near clip plane"]);
                    camera.farClipPlane = Number(written["far clip plane"]);
                    camera.fieldOfView = Number(written["field of view"]);
                    camera.depth = Number(written["m_Depth"]);
                    break;
                case Light light:
                    light.type = (LightType)int.Parse(written["m_Type"]);
                    light.color = (Color)Parsed(written["m_Color"], typeof(Color));
                    light.intensity = Number(written["m_Intensity"]);
                    light.shadows = (LightShadows)int.Parse(written["m_Shadows.m_Type"]);
                    break;
                case BoxCollider box:
                    box.size = Vector(written["m_Size"]);
                    break;
                case CapsuleCollider capsule:
                    capsule.enabled = written["m_Enabled"] == "1";
                    capsule.radius = Number(written["m_Radius"]);
                    capsule.height = Number(written["m_Height"]);
                    capsule.direction = int.Parse(written["m_Direction"]);
                    break;
                case Collider collider:
                    collider.enabled = written["m_Enabled"] == "1";
                    break;
                case TextMesh text:
                    text.text = Regex.Unescape(written["m_Text"].Trim('"'));
                    break;
                case MonoBehaviour script:
                    foreach (string field in written.ScriptFields)
                    {
                        Set(script, field, written, field, prefix);
                    }
                    break;
            }
        }

        private void Set(object target, string field, PrefabObject written, string key, string prefix)
        {
            FieldInfo? declared = null;
            for (Type? type = target.GetType(); type != null && declared == null; type = type.BaseType)
            {
                declared = type.GetField(field, BindingFlags.Instance | BindingFlags.Public | BindingFlags.NonPublic);
            }
            if (declared == null)
            {
                throw new InvalidDataException($"{target.GetType().Name} has no field {field}");
            }
            string value = written[key];
            if (typeof(Object[]).IsAssignableFrom(declared.FieldType))
            {
                return;
            }
            if (typeof(Object).IsAssignableFrom(declared.FieldType))
            {
                string anchor = PrefabObject.Reference(value);
                declared.SetValue(target, anchor == "0" || value.Contains("guid: ") ? null : made[prefix + anchor]);
            }
            else if (declared.FieldType == typeof(LayerMask))
            {
                declared.SetValue(target, (LayerMask)unchecked((int)uint.Parse(written[key + ".m_Bits"])));
            }
            else if (value.Length == 0 && written.NestedFields(key).Any())
            {
                foreach (string nested in written.NestedFields(key))
                {
                    Set(declared.GetValue(target)!, nested, written, key + "." + nested, prefix);
                }
            }
            else
            {
                declared.SetValue(target, Parsed(value, declared.FieldType));
            }
        }

        private static object Parsed(string value, Type type)
        {
            float[] numbers = PrefabObject.Numbers(value);
            return type == typeof(string) ? value
                : type == typeof(bool) ? value == "1"
                : type == typeof(Vector3) ? Vector(value)
                : type == typeof(Color) ? new Color(numbers[0], numbers[1], numbers[2], numbers[3])
                : type.IsEnum ? Enum.ToObject(type, int.Parse(value))
                : Convert.ChangeType(value, type, CultureInfo.InvariantCulture);
        }

        private static float Number(string text) => float.Parse(text, CultureInfo.InvariantCulture);

        private static Vector3 Vector(string text)
        {
            float[] numbers = PrefabObject.Numbers(text);
            return new Vector3(numbers[0], numbers[1], numbers[2]);
        }

        private static string GuidIn(string reference) => Regex.Match(reference, "guid: (\\w+)").Groups[1].Value;

        private static Dictionary<string, string> FindPaths() =>
            new[] { RepositoryFiles.In("Assets"), RepositoryFiles.In("Packages", "com.haptoflow.runtime", "Runtime") }
                .SelectMany(folder => Directory.EnumerateFiles(folder, "*.meta", SearchOption.AllDirectories))
                .ToDictionary(path => GuidIn(File.ReadAllText(path)), path => path.Substring(0, path.Length - 5));
    }

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

        public IEnumerable<string> NestedFields(string name) => fields.Keys
            .Where(key => key.StartsWith(name + ".")).Select(key => key.Substring(name.Length + 1));

        public IReadOnlyList<string> List(string name) => lists[name];

        public static string Reference(string value) => Regex.Match(value, @"fileID: (\d+)").Groups[1].Value;

        public static float[] Numbers(string value) => Regex.Matches(value, @"\w: ([-0-9.e]+)")
            .Select(match => float.Parse(match.Groups[1].Value, CultureInfo.InvariantCulture)).ToArray();
    }
}
