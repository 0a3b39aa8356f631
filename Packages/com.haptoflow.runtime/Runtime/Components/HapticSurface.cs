#nullable enable
using System.Collections.Generic;
using UnityEngine;

namespace HaptoFlow
{
    /// <summary>Makes a GameObject's colliders feelable: says what they are made of.</summary>
    /// <remarks>Box, sphere, capsule and character colliders are exact. Mesh and terrain colliders are asked by rays
    /// against their front faces: a tip deeper than 20 mm behind one is outside again. Triggers and wheel colliders are
    /// left out.
    /// </remarks>
    [AddComponentMenu("HaptoFlow/Haptic Surface")]
    [DisallowMultipleComponent]
    [HelpURL(HelpPages.Components + "haptic-surface")]
    public sealed class HapticSurface : MonoBehaviour
    {
        [SerializeField, Tooltip("A material shared with other surfaces; empty to describe one here.")]
        private HapticMaterial? sharedMaterial;

        [SerializeField]
        private MaterialDescription own = new MaterialDescription();

        [SerializeField, Tooltip("Colliders of children count too, but for those below another Haptic Surface.")]
        private bool includeChildren = true;

        [SerializeField, Tooltip("The object's own motion is felt: off, only the hand's speed over the world counts.")]
        private bool feelOwnMotion = true;

        [SerializeField, Tooltip("Direction of the first tangent axis, in the object's local space: along the grain.")]
        private Vector3 grain = new Vector3(1f, 0f, 0f);

        private readonly List<Collider> registered = new List<Collider>();
        private LabelBlend blend;
        private double labelStiffness;
        private int lookedUpVersion = -1;
        private MaterialDescription? lookedUpIn;
        private int lookedUpLabels = -1;

        /// <summary>A shared material; null where the surface describes its own.</summary>
        public HapticMaterial? SharedMaterial
        {
            get => sharedMaterial;
            set => sharedMaterial = value;
        }

        /// <summary>What counts: the shared material's description, or the surface's own.</summary>
        public MaterialDescription Material => sharedMaterial != null ? sharedMaterial.Description : own;

        /// <summary>Colliders of children count too. Takes effect at <see cref="Refresh"/>.</summary>
        public bool IncludeChildren
        {
            get => includeChildren;
            set => includeChildren = value;
        }

        /// <summary>The tip's velocity is taken relative to the object; off, relative to the world.</summary>
        public bool FeelOwnMotion
        {
            get => feelOwnMotion;
            set => feelOwnMotion = value;
        }

        /// <summary>Direction of the first tangent axis, in the object's local space.</summary>
        public Vector3 Grain
        {
            get => grain;
            set => grain = value;
        }

        /// <summary>Colliders that lead to this surface.</summary>
        public IReadOnlyList<Collider> Colliders => registered;

        /// <summary>Looks for colliders again: after some were added, removed or moved to another parent. Main thread;
        /// makes garbage.</summary>
        public void Refresh()
        {
            Unregister();
            if (isActiveAndEnabled)
            {
                Register();
            }
        }

        /// <summary>The labels as the engine takes them, looked up again only when something changed.</summary>
        internal LabelBlend BlendFor(HapticSession session)
        {
            LookUp(session);
            return blend;
        }

        /// <summary>In N/m; 0 for the contact model's default.</summary>
        internal double StiffnessFor(HapticSession session)
        {
            LookUp(session);
            float described = Material.StiffnessNewtonsPerMetre;
            return described > 0f ? described : labelStiffness;
        }

        private void LookUp(HapticSession session)
        {
            MaterialDescription material = Material;
            bool known = ReferenceEquals(material, lookedUpIn) && material.Version == lookedUpVersion &&
                session.LabelsVersion == lookedUpLabels;
            if (known)
            {
                return;
            }
            lookedUpIn = material;
            lookedUpVersion = material.Version;
            lookedUpLabels = session.LabelsVersion;
            blend = session.Labels.Blend(material, this, out labelStiffness);
        }

        private void OnEnable() => Register();

        private void OnDisable() => Unregister();

        private void OnValidate() => own.Touch();

        private void Register()
        {
            if (includeChildren)
            {
                GetComponentsInChildren(true, registered);
                registered.RemoveAll(candidate => SurfaceRegistry.OwnerOf(candidate.transform) != this);
            }
            else
            {
                GetComponents(registered);
            }
            foreach (Collider candidate in registered)
            {
                SurfaceRegistry.Add(candidate, this);
            }
        }

        private void Unregister()
        {
            foreach (Collider candidate in registered)
            {
                SurfaceRegistry.Remove(candidate, this);
            }
            registered.Clear();
        }
    }
}
