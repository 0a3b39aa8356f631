#nullable enable
using HaptoFlow.Numerics;
using UnityEngine;

namespace HaptoFlow
{
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
