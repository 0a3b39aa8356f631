#nullable enable
using System.Collections.Generic;
using UnityEngine;
using UnityEngine.SceneManagement;

namespace HaptoFlow
{
    /// <summary>The maps that count: those of a scene first, then the project's. Main thread.</summary>
    internal static class MaterialMaps
    {
        private static readonly List<HapticMaterialMapScope> Scopes = new List<HapticMaterialMapScope>();
        private static HapticMaterialMap? project;

        /// <summary>One more at each change of any map, of any scope, or of the project's choice.</summary>
        public static int Version { get; private set; }

        /// <summary>Any map counts anywhere.</summary>
        public static bool Any => project is object || Scopes.Count > 0;

        public static void Change() => ++Version;

        /// <summary>Once a frame: another project's map may count by now.</summary>
        public static void Poll()
        {
            HapticMaterialMap? chosen = HaptoFlowSettings.Active.MaterialMap;
            chosen = chosen != null ? chosen : null;
            if (!ReferenceEquals(chosen, project))
            {
                project = chosen;
                Change();
            }
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
            // By insertion: equal ones stay in the order in which they came.
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

        /// <summary>In the order in which they are asked.</summary>
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

        /// <summary>Has what the rules lead to registered before it is touched.</summary>
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
}
