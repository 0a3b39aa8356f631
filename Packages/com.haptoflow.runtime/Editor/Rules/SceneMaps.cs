#nullable enable
using System.Collections.Generic;
using System.Linq;
using UnityEngine;

namespace HaptoFlow.Editor
{
    /// <summary>The maps in use in the open scenes, found in the same way as <see cref="MaterialMaps"/> finds them in
    /// play mode.</summary>
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

        /// <summary>The maps of the open scenes and that of the project.</summary>
        public IReadOnlyList<HapticMaterialMap> All => scopes.Select(scope => scope.Map!).Append(project!)
            .Where(map => map != null).Distinct().ToArray();

        /// <summary>The maps for an object, in the order in which they apply.</summary>
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

        /// <summary>What a collider feels like, and why. A surface takes precedence over rules.</summary>
        public ColliderMaterial Ask(Collider collider)
        {
            HapticSurface? surface = SceneColliders.SurfaceOf(collider);
            bool isActive = surface != null && surface.enabled && surface.gameObject.activeInHierarchy;
            return new ColliderMaterial(
                collider, isActive ? surface : null, new MappedCollider(collider, For(collider.gameObject)));
        }
    }
}
