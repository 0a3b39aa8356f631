using System;

namespace UnityEngine
{
    public struct Vector3 : IEquatable<Vector3>
    {
        public float x;
        public float y;
        public float z;

        public Vector3(float x, float y, float z)
        {
            this.x = x;
            this.y = y;
            this.z = z;
        }

        public static Vector3 zero => new Vector3(0f, 0f, 0f);
        public static Vector3 one => new Vector3(1f, 1f, 1f);
        public static Vector3 up => new Vector3(0f, 1f, 0f);
        public static Vector3 down => new Vector3(0f, -1f, 0f);
        public static Vector3 right => new Vector3(1f, 0f, 0f);
        public static Vector3 left => new Vector3(-1f, 0f, 0f);
        public static Vector3 forward => new Vector3(0f, 0f, 1f);
        public static Vector3 back => new Vector3(0f, 0f, -1f);

        public float magnitude => (float)Math.Sqrt(x * x + y * y + z * z);
        public float sqrMagnitude => x * x + y * y + z * z;
        public Vector3 normalized => magnitude > 1e-5f ? this / magnitude : zero;

        public static Vector3 operator +(Vector3 a, Vector3 b) => new Vector3(a.x + b.x, a.y + b.y, a.z + b.z);
        public static Vector3 operator -(Vector3 a, Vector3 b) => new Vector3(a.x - b.x, a.y - b.y, a.z - b.z);
        public static Vector3 operator -(Vector3 a) => new Vector3(-a.x, -a.y, -a.z);
        public static Vector3 operator *(Vector3 a, float d) => new Vector3(a.x * d, a.y * d, a.z * d);
        public static Vector3 operator *(float d, Vector3 a) => a * d;
        public static Vector3 operator /(Vector3 a, float d) => new Vector3(a.x / d, a.y / d, a.z / d);
        public static bool operator ==(Vector3 lhs, Vector3 rhs) => (lhs - rhs).sqrMagnitude < 9.99999944E-11f;
        public static bool operator !=(Vector3 lhs, Vector3 rhs) => !(lhs == rhs);

        public static float Dot(Vector3 lhs, Vector3 rhs) => lhs.x * rhs.x + lhs.y * rhs.y + lhs.z * rhs.z;
        public static float Distance(Vector3 a, Vector3 b) => (a - b).magnitude;
        public static Vector3 Scale(Vector3 a, Vector3 b) => new Vector3(a.x * b.x, a.y * b.y, a.z * b.z);
        public static Vector3 Lerp(Vector3 a, Vector3 b, float t) => a + (b - a) * Mathf.Clamp01(t);

        public static Vector3 Cross(Vector3 lhs, Vector3 rhs) => new Vector3(
            lhs.y * rhs.z - lhs.z * rhs.y, lhs.z * rhs.x - lhs.x * rhs.z, lhs.x * rhs.y - lhs.y * rhs.x);

        public bool Equals(Vector3 other) => x == other.x && y == other.y && z == other.z;
        public override bool Equals(object? other) => other is Vector3 vector && Equals(vector);
        public override int GetHashCode() => HashCode.Combine(x, y, z);
        public override string ToString() => FormattableString.Invariant($"({x:F2}, {y:F2}, {z:F2})");
    }

    public struct Quaternion : IEquatable<Quaternion>
    {
        public float x;
        public float y;
        public float z;
        public float w;

        public Quaternion(float x, float y, float z, float w)
        {
            this.x = x;
            this.y = y;
            this.z = z;
            this.w = w;
        }

        public static Quaternion identity => new Quaternion(0f, 0f, 0f, 1f);

        public static Vector3 operator *(Quaternion rotation, Vector3 point)
        {
            var axis = new Vector3(rotation.x, rotation.y, rotation.z);
            Vector3 once = Vector3.Cross(axis, point);
            return point + 2f * (rotation.w * once + Vector3.Cross(axis, once));
        }

        public static Quaternion operator *(Quaternion lhs, Quaternion rhs) => new Quaternion(
            lhs.w * rhs.x + lhs.x * rhs.w + lhs.y * rhs.z - lhs.z * rhs.y,
            lhs.w * rhs.y + lhs.y * rhs.w + lhs.z * rhs.x - lhs.x * rhs.z,
            lhs.w * rhs.z + lhs.z * rhs.w + lhs.x * rhs.y - lhs.y * rhs.x,
            lhs.w * rhs.w - lhs.x * rhs.x - lhs.y * rhs.y - lhs.z * rhs.z);

        public static bool operator ==(Quaternion lhs, Quaternion rhs) => Dot(lhs, rhs) > 0.999999f;
        public static bool operator !=(Quaternion lhs, Quaternion rhs) => !(lhs == rhs);

        public static float Dot(Quaternion a, Quaternion b) => a.x * b.x + a.y * b.y + a.z * b.z + a.w * b.w;
        public static Quaternion Inverse(Quaternion rotation) =>
            new Quaternion(-rotation.x, -rotation.y, -rotation.z, rotation.w);

        public static Quaternion AngleAxis(float angle, Vector3 axis)
        {
            double half = 0.5 * angle * Math.PI / 180.0;
            Vector3 unit = axis.normalized * (float)Math.Sin(half);
            return new Quaternion(unit.x, unit.y, unit.z, (float)Math.Cos(half));
        }

        public static Quaternion FromToRotation(Vector3 fromDirection, Vector3 toDirection)
        {
            Vector3 from = fromDirection.normalized;
            Vector3 to = toDirection.normalized;
            float w = 1f + Vector3.Dot(from, to);
            if (w < 1e-6f)
            {
                Vector3 other = Math.Abs(from.x) < 0.9f ? Vector3.right : Vector3.up;
                return AngleAxis(180f, Vector3.Cross(from, other));
            }
            Vector3 turn = Vector3.Cross(from, to);
            return new Quaternion(turn.x, turn.y, turn.z, w).normalized;
        }

        public static Quaternion Slerp(Quaternion a, Quaternion b, float t)
        {
            float cosine = Dot(a, b);
            float sign = cosine < 0f ? -1f : 1f;
            double angle = Math.Acos(Math.Min(1.0, sign * cosine));
            double sine = Math.Sin(angle);
            float share = Mathf.Clamp01(t);
            float toA = sine > 1e-6 ? (float)(Math.Sin((1f - share) * angle) / sine) : 1f - share;
            float toB = sign * (sine > 1e-6 ? (float)(Math.Sin(share * angle) / sine) : share);
            return new Quaternion(
                toA * a.x + toB * b.x, toA * a.y + toB * b.y, toA * a.z + toB * b.z, toA * a.w + toB * b.w).normalized;
        }

        public Quaternion normalized
        {
            get
            {
                float length = (float)Math.Sqrt(Dot(this, this));
                return length < 1e-12f ? identity : new Quaternion(x / length, y / length, z / length, w / length);
            }
        }

        public bool Equals(Quaternion other) => x == other.x && y == other.y && z == other.z && w == other.w;
        public override bool Equals(object? other) => other is Quaternion rotation && Equals(rotation);
        public override int GetHashCode() => HashCode.Combine(x, y, z, w);
    }

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
