using System;

namespace UnityEngine
{
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
}
