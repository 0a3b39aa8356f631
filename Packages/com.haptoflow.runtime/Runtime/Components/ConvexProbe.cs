#nullable enable
using HaptoFlow.Contact;
using HaptoFlow.Numerics;
using UnityEngine;

namespace HaptoFlow
{
    /// <summary>The nearest place on a convex mesh for a tip outside of it: the physics engine knows it exactly, where
    /// the mesh is drawn.</summary>
    internal static class ConvexProbe
    {
        // Nearer, the direction to the nearest place is mostly rounding: rays give the face's own normal.
        private const double LeastDistanceMetres = 1e-4;

        /// <summary>False for a tip inside the mesh or on it.</summary>
        public static bool TryOutside(
            MeshCollider mesh, in RigidPose pose, in ProbeQuestion question, out SurfacePoint found)
        {
            mesh.transform.GetPositionAndRotation(out Vector3 position, out Quaternion rotation);
            Vector3 nearest = Physics.ClosestPoint(question.TipMetres.ToVector(), mesh, position, rotation);
            Double3 tip = pose.PointToLocal(question.TipMetres);
            Double3 point = pose.PointToLocal(nearest.ToDouble());
            double distance = Double3.Distance(tip, point);
            found = new SurfacePoint(point, Vectors.UnitOr(tip - point, Double3.Up), distance);
            return distance > LeastDistanceMetres;
        }
    }
}
