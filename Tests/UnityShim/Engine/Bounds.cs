using System;

namespace UnityEngine
{
    public struct Bounds : IEquatable<Bounds>
    {
        private Vector3 middle;
        private Vector3 half;

        public Bounds(Vector3 center, Vector3 size)
        {
            middle = center;
            half = 0.5f * size;
        }

        public Vector3 center
        {
            get => middle;
            set => middle = value;
        }

        public Vector3 size
        {
            get => 2f * half;
            set => half = 0.5f * value;
        }

        public Vector3 min => middle - half;
        public Vector3 max => middle + half;

        public float SqrDistance(Vector3 point) => (point - new Vector3(
            Mathf.Clamp(point.x, min.x, max.x),
            Mathf.Clamp(point.y, min.y, max.y),
            Mathf.Clamp(point.z, min.z, max.z))).sqrMagnitude;

        public void Encapsulate(Vector3 point)
        {
            Vector3 lowest = new Vector3(
                Mathf.Min(min.x, point.x), Mathf.Min(min.y, point.y), Mathf.Min(min.z, point.z));
            Vector3 highest = new Vector3(
                Mathf.Max(max.x, point.x), Mathf.Max(max.y, point.y), Mathf.Max(max.z, point.z));
            middle = 0.5f * (lowest + highest);
            half = 0.5f * (highest - lowest);
        }

        public bool Equals(Bounds other) => middle.Equals(other.middle) && half.Equals(other.half);
        public override bool Equals(object? other) => other is Bounds bounds && Equals(bounds);
        public override int GetHashCode() => HashCode.Combine(middle, half);
    }
}
