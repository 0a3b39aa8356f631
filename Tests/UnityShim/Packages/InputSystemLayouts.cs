using System;
using System.Collections.Generic;
using System.Linq;
using System.Text.RegularExpressions;
using UnityEngine.InputSystem.Layouts;
using UnityShim;

namespace UnityEngine.InputSystem
{
    public static partial class InputSystem
    {
        internal static Dictionary<string, (Type Type, InputDeviceMatcher Matches)> Layouts { get; } =
            new Dictionary<string, (Type, InputDeviceMatcher)>();

        public static void RegisterLayout(Type type, string? name = null, InputDeviceMatcher? matches = null) =>
            Layouts[name ?? type.Name] = (type, matches ?? default);

        public static void RemoveLayout(string name) => Layouts.Remove(name);
    }
}

namespace UnityEngine.InputSystem.Layouts
{
    [AttributeUsage(AttributeTargets.Field | AttributeTargets.Property, AllowMultiple = true)]
    public sealed class InputControlAttribute : PropertyAttribute
    {
        internal const uint Automatic = uint.MaxValue;

        public string? usage { get; set; }

        public string? alias { get; set; }

        public string[]? aliases { get; set; }

        public uint offset { get; set; } = Automatic;

        public bool noisy { get; set; }
    }

    [AttributeUsage(AttributeTargets.Class, Inherited = false)]
    public sealed class InputControlLayoutAttribute : Attribute
    {
        public string? displayName { get; set; }

        public string[]? commonUsages { get; set; }
    }

    public struct InputDeviceMatcher
    {
        private (string Key, string Pattern, bool IsRegex)[]? patterns;

        public InputDeviceMatcher WithInterface(string pattern, bool supportRegex = true) =>
            With("interface", pattern, supportRegex);

        public InputDeviceMatcher WithProduct(string pattern, bool supportRegex = true) =>
            With("product", pattern, supportRegex);

        internal bool Matches(string interfaceName, string product) => patterns != null && patterns.All(each =>
        {
            string value = each.Key == "product" ? product : interfaceName;
            return each.IsRegex
                ? Regex.IsMatch(value, each.Pattern, RegexOptions.IgnoreCase)
                : string.Equals(value, each.Pattern, StringComparison.OrdinalIgnoreCase);
        });

        private InputDeviceMatcher With(string key, string pattern, bool supportRegex)
        {
            bool isRegex = supportRegex && !pattern.All(each => char.IsLetterOrDigit(each) || char.IsWhiteSpace(each));
            return new InputDeviceMatcher
            {
                patterns = (patterns ?? Array.Empty<(string, string, bool)>()).Append((key, pattern, isRegex)).ToArray(),
            };
        }
    }
}

namespace UnityEngine.InputSystem.XR
{
    public static class XRUtilities
    {
        public const string InterfaceMatchAnyVersion = "^(XRInput)";
    }
}
