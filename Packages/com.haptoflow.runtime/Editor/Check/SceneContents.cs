#nullable enable
using System;
using System.Collections.Generic;
using System.Linq;
using UnityEngine;
using Object = UnityEngine.Object;

namespace HaptoFlow.Editor
{
    /// <summary>The active objects of the open scenes that matter to haptics.</summary>
    internal sealed class SceneContents
    {
        public SceneContents()
        {
            Styluses = All<HapticStylus>();
            Surfaces = All<HapticSurface>();
            Outputs = All<HapticOutput>();
            Colliders = SceneColliders.InScenes().Where(IsInReach).ToArray();
            Maps = new SceneMaps();
            Answers = Colliders.Select(Maps.Ask).ToArray();
        }

        public IReadOnlyList<HapticStylus> Styluses { get; }

        public IReadOnlyList<HapticSurface> Surfaces { get; }

        public IReadOnlyList<HapticOutput> Outputs { get; }

        /// <summary>The colliders that can be felt, on the layers of any stylus; on all layers when there is no stylus.
        /// </summary>
        public IReadOnlyList<Collider> Colliders { get; }

        /// <summary>The material maps in use.</summary>
        public SceneMaps Maps { get; }

        /// <summary>What each of <see cref="Colliders"/> feels like, and why.</summary>
        public IReadOnlyList<ColliderMaterial> Answers { get; }

        private bool IsInReach(Collider collider)
        {
            int layer = 1 << collider.gameObject.layer;
            return Styluses.Count == 0 || Styluses.Any(stylus => (stylus.Layers.value & layer) != 0);
        }

        private static IReadOnlyList<T> All<T>()
            where T : Behaviour => Object.FindObjectsByType<T>(FindObjectsInactive.Exclude, FindObjectsSortMode.None)
            .Where(each => each.enabled)
            .OrderBy(each => each.name, StringComparer.Ordinal)
            .ToArray();
    }
}
