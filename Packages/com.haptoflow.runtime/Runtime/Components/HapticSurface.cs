#nullable enable
using System.Collections.Generic;
using UnityEngine;

namespace HaptoFlow
{
    /// <summary>Makes a GameObject's colliders feelable: says what they are made of.</summary>
    /// <remarks>Box, sphere, capsule and character colliders are exact, and so are convex meshes for a tip outside of
    /// them. Other mesh and terrain colliders are asked by rays against their front faces, whatever
    /// Physics.queriesHitBackfaces says: a tip deeper than 20 mm behind one is outside again. Triggers and wheel
    /// colliders are left out.</remarks>
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

        [SerializeField, Tooltip("Further materials by a texture, at the place that is touched; empty for none.")]
        private HapticMaskMap? mask;

        private readonly List<Collider> registered = new List<Collider>();
        private bool isStale;
        private readonly MaterialLookUp ownLookUp = new MaterialLookUp();

        /// <summary>The shared material asset; null where the surface describes its own. Changing the asset changes
        /// every surface that shares it, as Renderer.sharedMaterial does.</summary>
        public HapticMaterial? SharedMaterial
        {
            get => sharedMaterial;
            set
            {
                sharedMaterial = value;
                HapticSession.Existing?.Prepare(SharedDescription);
            }
        }

        /// <summary>What this surface is made of, to be changed: changes reach no other surface and no asset. As with
        /// Renderer.material, asking for it gives a surface with a shared material a copy of its own, and
        /// <see cref="SharedMaterial"/> is null from then on. To read only, ask
        /// <see cref="SharedDescription"/>.</summary>
        public MaterialDescription Material
        {
            get
            {
                if (sharedMaterial != null)
                {
                    own.CopyFrom(sharedMaterial.Description);
                    sharedMaterial = null;
                }
                return own;
            }
        }

        /// <summary>What counts, to be read: the shared material's description, or the surface's own. A change of a
        /// shared one changes the asset and every surface that shares it.</summary>
        public MaterialDescription SharedDescription => sharedMaterial != null ? sharedMaterial.Description : own;

        /// <summary>Colliders of children count too.</summary>
        public bool IncludeChildren
        {
            get => includeChildren;
            set
            {
                includeChildren = value;
                isStale = true;
            }
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

        /// <summary>Further materials by a texture, at the place that is touched; null for none.</summary>
        public HapticMaskMap? Mask
        {
            get => mask;
            set => mask = value;
        }

        /// <summary>Colliders that lead to this surface. A child that comes or goes, and a collider added deeper below,
        /// are noticed without help.</summary>
        public IReadOnlyList<Collider> Colliders
        {
            get
            {
                if (isStale)
                {
                    Refresh();
                }
                return registered;
            }
        }

        /// <summary>Looks for colliders again now: only so that <see cref="Colliders"/> lists one that was added to, or
        /// removed from, an object deeper below before a tip came near. Main thread; makes garbage.</summary>
        public void Refresh()
        {
            Unregister();
            if (isActiveAndEnabled)
            {
                Register();
            }
        }

        /// <summary>The collider is where this surface looks, if no nearer surface stands between.</summary>
        internal bool Reaches(Collider collider) => includeChildren
            ? collider.transform.IsChildOf(transform)
            : ReferenceEquals(collider.gameObject, gameObject);

        /// <summary>A registered collider needs no new look-up.</summary>
        internal bool Keeps(Collider collider) => !isStale && Reaches(collider);

        /// <summary>Takes a collider that was found below this surface.</summary>
        internal void Adopt(Collider collider)
        {
            if (isStale)
            {
                Refresh();
            }
            if (!registered.Contains(collider))
            {
                registered.Add(collider);
            }
            SurfaceRegistry.Add(collider, this);
        }

        /// <summary>The labels as the engine takes them, looked up again only when something changed.</summary>
        internal LabelBlend BlendFor(HapticSession session) => LookUp(session).Labels;

        /// <summary>In N/m; 0 for the contact model's default.</summary>
        internal double StiffnessFor(HapticSession session) => LookUp(session).StiffnessNewtonsPerMetre;

        /// <summary>What a place on one of the colliders feels like; labels of none where it is nothing.</summary>
        internal FeltMaterial At(in TouchedPlace place, HapticSession session)
        {
            FeltMaterial whole = FeltMaterial.Of(SharedDescription, LookUp(session));
            return mask != null && mask.TryFeel(place, whole, session, this, out FeltMaterial felt) ? felt : whole;
        }

        private MaterialLookUp LookUp(HapticSession session) => sharedMaterial != null
            ? sharedMaterial.LookUp(session, this)
            : ownLookUp.Of(own, session, this);

        private void OnEnable()
        {
            Register();
            TellSurfaceAbove();
            HapticSession.Existing?.Prepare(SharedDescription);
        }

        private void OnDisable() => Unregister();

        private void OnDestroy() => TellSurfaceAbove();

        // Told of direct children only; what changes deeper below is noticed when a tip comes near.
        private void OnTransformChildrenChanged() => isStale = true;

        private void OnValidate()
        {
            own.Touch();
            isStale = true;
        }

        /// <summary>The colliders here were, or become, those of the surface above.</summary>
        private void TellSurfaceAbove()
        {
            HapticSurface? above = SurfaceRegistry.OwnerOf(transform.parent);
            if (above != null)
            {
                above.isStale = true;
            }
        }

        private void Register()
        {
            isStale = false;
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
