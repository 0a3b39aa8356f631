#nullable enable
using System.Collections.Generic;
using HaptoFlow.Model;
using UnityEngine;
using UnityEngine.SceneManagement;

namespace HaptoFlow
{
    /// <summary>The maps in effect: those of a scene first, then the project's. Main thread.</summary>
    internal static class MaterialMaps
    {
        private static readonly List<HapticMaterialMapScope> Scopes = new List<HapticMaterialMapScope>();
        private static HapticMaterialMap? project;

        /// <summary>Increases with each change of a map, a scope, or the project's choice.</summary>
        public static int Version { get; private set; }

        /// <summary>True where any map is in effect.</summary>
        public static bool Any => project is object || Scopes.Count > 0;

        public static void Change() => ++Version;

        /// <summary>Call once a frame: detects a change of the project's map, and reads terrains ahead.</summary>
        public static void Poll()
        {
            HapticMaterialMap? chosen = HaptoFlowSettings.Active.MaterialMap;
            chosen = chosen != null ? chosen : null;
            if (!ReferenceEquals(chosen, project))
            {
                project = chosen;
                Change();
            }
            TerrainWeights.Poll();
        }

        public static void Add(HapticMaterialMapScope scope)
        {
            if (!Scopes.Contains(scope))
            {
                Scopes.Add(scope);
                Reorder();
            }
        }

        public static void Remove(HapticMaterialMapScope scope)
        {
            Scopes.Remove(scope);
            Change();
        }

        public static void Reorder()
        {
            // Insertion sort: entries of equal order keep their sequence.
            for (int index = 1; index < Scopes.Count; ++index)
            {
                HapticMaterialMapScope scope = Scopes[index];
                int place = index;
                for (; place > 0 && Scopes[place - 1].Order > scope.Order; --place)
                {
                    Scopes[place] = Scopes[place - 1];
                }
                Scopes[place] = scope;
            }
            Change();
        }

        /// <summary>Lists the maps of a scene in the order in which they are tried.</summary>
        public static void CollectFor(Scene scene, List<HapticMaterialMap> maps)
        {
            maps.Clear();
            foreach (HapticMaterialMapScope scope in Scopes)
            {
                if (scope.Map != null && scope.gameObject.scene == scene)
                {
                    maps.Add(scope.Map);
                }
            }
            if (project is object && project != null)
            {
                maps.Add(project);
            }
        }

        /// <summary>Registers the learnt materials of all rules before they are touched.</summary>
        public static void PrepareAll(HapticSession session)
        {
            Poll();
            Prepare(session, project);
            foreach (HapticMaterialMapScope scope in Scopes)
            {
                Prepare(session, scope.Map);
            }
        }

        private static void Prepare(HapticSession session, HapticMaterialMap? map)
        {
            if (map == null)
            {
                return;
            }
            foreach (HapticMaterialRule rule in map.Rules)
            {
                Prepare(session, rule.Material);
            }
            Prepare(session, map.DefaultMaterial);
        }

        private static void Prepare(HapticSession session, HapticMaterial? material)
        {
            if (material != null)
            {
                session.Prepare(material.Description);
            }
        }

        [RuntimeInitializeOnLoadMethod(RuntimeInitializeLoadType.SubsystemRegistration)]
        private static void Forget()
        {
            Scopes.Clear();
            project = null;
            Change();
        }
    }

    /// <summary>Matches names against patterns in which <c>*</c> stands for any number of characters. Case is ignored.
    /// So is the form of accents: some systems write a name with them apart from their letters. Not by Regex, which
    /// allocates per match and interprets user text as a pattern language.</summary>
    internal static class NamePattern
    {
        /// <summary>True where the pattern matches the whole name; an empty pattern matches nothing.</summary>
        public static bool Matches(string pattern, string name)
        {
            pattern = LabelSpelling.Composed(pattern);
            name = LabelSpelling.Composed(name);
            int inPattern = 0;
            int inName = 0;
            int lastStar = -1;
            int resumeAt = 0;
            while (inName < name.Length)
            {
                if (inPattern < pattern.Length && pattern[inPattern] == '*')
                {
                    lastStar = inPattern++;
                    resumeAt = inName;
                }
                else if (inPattern < pattern.Length && IsSame(pattern[inPattern], name[inName]))
                {
                    ++inPattern;
                    ++inName;
                }
                else if (lastStar >= 0)
                {
                    // Backtrack: let the last star match one character more.
                    inPattern = lastStar + 1;
                    inName = ++resumeAt;
                }
                else
                {
                    return false;
                }
            }
            while (inPattern < pattern.Length && pattern[inPattern] == '*')
            {
                ++inPattern;
            }
            return pattern.Length > 0 && inPattern == pattern.Length;
        }

        private static bool IsSame(char first, char second) =>
            char.ToUpperInvariant(first) == char.ToUpperInvariant(second);
    }
}
