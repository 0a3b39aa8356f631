#nullable enable
using HaptoFlow.Contact;
using HaptoFlow.Numerics;
using UnityEngine;

namespace HaptoFlow
{
    /// <summary>Metres of the world for a metre of the hand: the scale of the rig that carries a pen. Main thread, no
    /// garbage.</summary>
    /// <remarks>The contact model works in metres of the hand, so that the limits of a hand, the tip and the force mean
    /// the same in a doll house and for a giant; only geometry comes from the world, divided by this.</remarks>
    internal sealed class RigScale
    {
        private const float Smallest = 1e-3f;
        private const float Largest = 1e3f;

        // Rounding of nested scales is no scale.
        private const float Slack = 1e-4f;

        // Looking for the camera costs something, and rigs hardly change.
        private const int UpdatesBetweenSearches = 64;

        private readonly HapticStylus stylus;
        private Transform? rig;
        private Transform? root;
        private int updates;

        public RigScale(HapticStylus stylus) => this.stylus = stylus;

        /// <summary>Metres of the world for a metre of the hand in this update.</summary>
        /// <param name="maySearch">False during a touch, which keeps its metre while its rig is there.</param>
        public double Update(bool maySearch)
        {
            bool isDue = maySearch && updates++ % UpdatesBetweenSearches == 0;
            if (isDue || root != stylus.transform.root || stylus.Rig != null)
            {
                root = stylus.transform.root;
                rig = RigOf(stylus);
            }
            return Of(rig);
        }

        /// <summary>The scale of a rig; 1 without one, and where its scale is not usable.</summary>
        public static double Of(Transform? rig)
        {
            if (rig == null)
            {
                return 1.0;
            }
            Vector3 scale = rig.lossyScale;
            float mean = (Mathf.Abs(scale.x) + Mathf.Abs(scale.y) + Mathf.Abs(scale.z)) / 3f;
            bool isUsable = mean >= Smallest && mean <= Largest;
            return isUsable && Mathf.Abs(mean - 1f) > Slack ? mean : 1.0;
        }

        /// <summary>The rig: the stylus's own field, else what carries the main camera and the stylus, else the root of
        /// the hierarchy above the pen. A pen that is scaled itself is no rig. Null without one.</summary>
        public static Transform? RigOf(HapticStylus stylus)
        {
            if (stylus.Rig != null)
            {
                return stylus.Rig;
            }
            Transform pen = stylus.transform;
            Transform root = pen.root;
            Camera? main = Camera.main;
            Transform? view = main != null ? main.transform.parent : null;
            if (view != null && view.root == root)
            {
                return view;
            }
            bool isPen = root == pen || (stylus.name == "Tip" && root == pen.parent);
            return isPen ? null : root;
        }

        public static RigidPose ToHand(in RigidPose world, double scale) => scale == 1.0
            ? world
            : new RigidPose(world.PositionMetres / scale, world.Rotation);

        public static SurfacePoint ToHand(in SurfacePoint world, double scale) => scale == 1.0
            ? world
            : new SurfacePoint(world.PointMetres / scale, world.Normal, world.SignedDistanceMetres / scale,
                world.BeyondMetres / scale);
    }

    /// <summary>Conversions between Unity's single precision and the contact model's double precision.</summary>
    internal static class Conversions
    {
        public static Double3 ToDouble(this Vector3 vector) => new Double3(vector.x, vector.y, vector.z);

        public static Vector3 ToVector(this Double3 vector) =>
            new Vector3((float)vector.X, (float)vector.Y, (float)vector.Z);

        public static RigidPose PoseOf(Transform transform)
        {
            transform.GetPositionAndRotation(out Vector3 position, out Quaternion rotation);
            return PoseOf(position, rotation);
        }

        public static RigidPose PoseOf(Vector3 position, Quaternion rotation) =>
            new RigidPose(position.ToDouble(), new Rotation(rotation.x, rotation.y, rotation.z, rotation.w));
    }
}
