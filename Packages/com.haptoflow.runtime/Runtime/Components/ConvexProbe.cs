#nullable enable
using HaptoFlow.Contact;
using HaptoFlow.Numerics;
using UnityEngine;

namespace HaptoFlow
{
    /// <summary>The closest point of a convex mesh to a tip outside of it, at the pose where the mesh is drawn. The
    /// physics engine computes it exactly.</summary>
    internal static class ConvexProbe
    {
        // At smaller distances rounding dominates the direction to the closest point; rays then give the face's own
        // normal.
        private const double MinimumDistanceMetres = 1e-4;

        /// <summary>False for a tip inside the mesh or on its surface, and for one that went through it and is held by
        /// the face that it entered.</summary>
        public static bool TryOutside(MeshCollider mesh, in RigidPose pose, in ProbeQuestion question,
            in HeldFace held, ref ProbeAnswer answer)
        {
            mesh.transform.GetPositionAndRotation(out Vector3 position, out Quaternion rotation);
            Vector3 nearest = Physics.ClosestPoint(question.TipMetres.ToVector(), mesh, position, rotation);
            Double3 tip = pose.PointToLocal(question.TipMetres);
            Double3 point = pose.PointToLocal(nearest.ToDouble());
            double distance = Double3.Distance(tip, point);
            Double3 normal = Vectors.UnitOr(tip - point, Double3.Up);
            answer.Point = new SurfacePoint(point, normal, distance);
            bool isAway = held.Holds(0.0) &&
                Double3.Dot(normal, held.Normal!.Value) < -HeldFace.SameSideCosine;
            return distance > MinimumDistanceMetres &&
                !(isAway && RayProbe.IsThrough(mesh, pose, question, held));
        }
    }
}
