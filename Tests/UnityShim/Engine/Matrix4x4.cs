namespace UnityEngine
{
    /// <summary>A transform. The shim keeps its parts only.</summary>
    public partial struct Matrix4x4
    {
        internal Vector3 Position;
        internal Quaternion Rotation;
        internal Vector3 Scale;

        public static Matrix4x4 TRS(Vector3 pos, Quaternion q, Vector3 s) =>
            new Matrix4x4 { Position = pos, Rotation = q, Scale = s };
    }
}
