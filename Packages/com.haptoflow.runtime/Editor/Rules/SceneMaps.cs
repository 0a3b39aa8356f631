#nullable enable
using System.Collections.Generic;
using System.Linq;
using UnityEngine;

namespace HaptoFlow.Editor
{
    /// <summary>The maps that count in the open scenes, by the rules that <see cref="MaterialMaps"/> goes by in play
    /// mode.</summary>
    internal sealed class SceneMaps
    {
        private readonly HapticMaterialMapScope[] scopes;
        private readonly HapticMaterialMap? project;

        public SceneMaps()
        {
            scopes = Object.FindObjectsByType<HapticMaterialMapScope>(
                    FindObjectsInactive.Exclude, FindObjectsSortMode.None)
                .Where(scope => scope.enabled && scope.Map != null)
                .OrderBy(scope => scope.Order)
                .ToArray();
            HaptoFlowSettings? settings = Application.isPlaying
                ? HaptoFlowSettings.Active
                : ProjectSettingsAsset.Find();
            project = settings != null && settings.MaterialMap != null ? settings.MaterialMap : null;
        }

        /// <summary>Those of scenes and the project's.</summary>
        public IReadOnlyList<HapticMaterialMap> All => scopes.Select(scope => scope.Map!).Append(project!)
            .Where(map => map != null).Distinct().ToArray();

        /// <summary>In the order in which they are asked.</summary>
        public IReadOnlyList<HapticMaterialMap> For(GameObject owner)
        {
            List<HapticMaterialMap> maps = scopes
                .Where(scope => scope.gameObject.scene == owner.scene).Select(scope => scope.Map!).ToList();
            if (project is object)
            {
                maps.Add(project);
            }
            return maps;
        }

        /// <summary>What a collider feels like, and why. An explicit surface wins.</summary>
        public ColliderAnswer Ask(Collider collider)
        {
            HapticSurface? surface = SceneColliders.SurfaceOf(collider);
            bool counts = surface != null && surface.enabled && surface.gameObject.activeInHierarchy;
            return new ColliderAnswer(
                collider, counts ? surface : null, new FeltCollider(collider, For(collider.gameObject)));
        }
    }
}
