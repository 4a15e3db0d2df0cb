using System;

namespace UnityEngine
{
    [Serializable]
    public struct Vector2
    {
        public float x, y;

        public Vector2(float x, float y) => (this.x, this.y) = (x, y);

        public static Vector2 zero => default;

        public static Vector2 one => new Vector2(1, 1);

        public static Vector2 operator -(Vector2 a, Vector2 b) => new Vector2(a.x - b.x, a.y - b.y);

        public static implicit operator Vector2(Vector3 v) => new Vector2(v.x, v.y);

        public static implicit operator Vector3(Vector2 v) => new Vector3(v.x, v.y, 0);
    }

    [Serializable]
    public struct Vector3 : IEquatable<Vector3>
    {
        public float x, y, z;

        public Vector3(float x, float y, float z) => (this.x, this.y, this.z) = (x, y, z);

        public static Vector3 zero => default;

        public static Vector3 one => new Vector3(1, 1, 1);

        public static Vector3 right => new Vector3(1, 0, 0);

        public static Vector3 up => new Vector3(0, 1, 0);

        public static Vector3 forward => new Vector3(0, 0, 1);

        public float sqrMagnitude => Dot(this, this);

        public float magnitude => (float)Math.Sqrt((double)x * x + (double)y * y + (double)z * z);

        public Vector3 normalized => magnitude > 1e-5f ? this / magnitude : zero;

        public static float Dot(Vector3 a, Vector3 b) => a.x * b.x + a.y * b.y + a.z * b.z;

        public static Vector3 Cross(Vector3 a, Vector3 b) => new Vector3(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);

        public static Vector3 Scale(Vector3 a, Vector3 b) => new Vector3(a.x * b.x, a.y * b.y, a.z * b.z);

        public static float Distance(Vector3 a, Vector3 b) => (a - b).magnitude;

        public static Vector3 operator +(Vector3 a, Vector3 b) => new Vector3(a.x + b.x, a.y + b.y, a.z + b.z);

        public static Vector3 operator -(Vector3 a, Vector3 b) => new Vector3(a.x - b.x, a.y - b.y, a.z - b.z);

        public static Vector3 operator -(Vector3 a) => new Vector3(-a.x, -a.y, -a.z);

        public static Vector3 operator *(Vector3 a, float s) => new Vector3(a.x * s, a.y * s, a.z * s);

        public static Vector3 operator *(float s, Vector3 a) => a * s;

        public static Vector3 operator /(Vector3 a, float s) => new Vector3(a.x / s, a.y / s, a.z / s);

        public static bool operator ==(Vector3 a, Vector3 b) => (a - b).sqrMagnitude < 9.99999944e-11f;

        public static bool operator !=(Vector3 a, Vector3 b) => !(a == b);

        public bool Equals(Vector3 other) => x == other.x && y == other.y && z == other.z;

        public override bool Equals(object other) => other is Vector3 v && Equals(v);

        public override int GetHashCode() => (x, y, z).GetHashCode();

        public override string ToString() => $"({x}, {y}, {z})";
    }

    [Serializable]
    public struct Vector4
    {
        public float x, y, z, w;

        public Vector4(float x, float y, float z, float w) => (this.x, this.y, this.z, this.w) = (x, y, z, w);
    }

    [Serializable]
    public struct Quaternion : IEquatable<Quaternion>
    {
        public float x, y, z, w;

        public Quaternion(float x, float y, float z, float w) => (this.x, this.y, this.z, this.w) = (x, y, z, w);

        public static Quaternion identity => new Quaternion(0, 0, 0, 1);

        public static Quaternion AngleAxis(float degrees, Vector3 axis)
        {
            double half = degrees * Math.PI / 360, sine = Math.Sin(half);
            Vector3 unit = axis.normalized;
            return new Quaternion((float)(sine * unit.x), (float)(sine * unit.y), (float)(sine * unit.z), (float)Math.Cos(half));
        }

        public static Quaternion Inverse(Quaternion q) => new Quaternion(-q.x, -q.y, -q.z, q.w);

        public static float Dot(Quaternion a, Quaternion b) => a.x * b.x + a.y * b.y + a.z * b.z + a.w * b.w;

        public static Quaternion FromToRotation(Vector3 from, Vector3 to)
        {
            Vector3 a = from.normalized, b = to.normalized, axis = Vector3.Cross(a, b);
            double w = 1 + (double)Vector3.Dot(a, b);
            if (w < 1e-7)
            {
                axis = Math.Abs(a.x) < 0.9f ? Vector3.Cross(a, Vector3.right) : Vector3.Cross(a, Vector3.up);
                w = 0;
            }

            double length = Math.Sqrt(axis.sqrMagnitude + w * w);
            return new Quaternion((float)(axis.x / length), (float)(axis.y / length), (float)(axis.z / length), (float)(w / length));
        }

        public static Quaternion operator *(Quaternion a, Quaternion b) => new Quaternion(
            (float)((double)a.w * b.x + (double)a.x * b.w + (double)a.y * b.z - (double)a.z * b.y),
            (float)((double)a.w * b.y + (double)a.y * b.w + (double)a.z * b.x - (double)a.x * b.z),
            (float)((double)a.w * b.z + (double)a.z * b.w + (double)a.x * b.y - (double)a.y * b.x),
            (float)((double)a.w * b.w - (double)a.x * b.x - (double)a.y * b.y - (double)a.z * b.z));

        public static Vector3 operator *(Quaternion q, Vector3 v)
        {
            double tx = 2 * ((double)q.y * v.z - (double)q.z * v.y), ty = 2 * ((double)q.z * v.x - (double)q.x * v.z), tz = 2 * ((double)q.x * v.y - (double)q.y * v.x);
            return new Vector3(
                (float)(v.x + q.w * tx + q.y * tz - q.z * ty),
                (float)(v.y + q.w * ty + q.z * tx - q.x * tz),
                (float)(v.z + q.w * tz + q.x * ty - q.y * tx));
        }

        public static bool operator ==(Quaternion a, Quaternion b) => Dot(a, b) > 1 - 1e-6f;

        public static bool operator !=(Quaternion a, Quaternion b) => !(a == b);

        public bool Equals(Quaternion other) => x == other.x && y == other.y && z == other.z && w == other.w;

        public override bool Equals(object other) => other is Quaternion q && Equals(q);

        public override int GetHashCode() => (x, y, z, w).GetHashCode();

        public override string ToString() => $"({x}, {y}, {z}, {w})";
    }

    [Serializable]
    public struct Color
    {
        public float r, g, b, a;

        public Color(float r, float g, float b, float a) => (this.r, this.g, this.b, this.a) = (r, g, b, a);

        public Color(float r, float g, float b)
            : this(r, g, b, 1)
        {
        }

        public static Color white => new Color(1, 1, 1, 1);

        public static Color black => new Color(0, 0, 0, 1);

        public static Color Lerp(Color a, Color b, float t) => new Color(a.r + t * (b.r - a.r), a.g + t * (b.g - a.g), a.b + t * (b.b - a.b), a.a + t * (b.a - a.a));

        /// <summary>From linear to sRGB; the opacity stays.</summary>
        public Color gamma => new Color(Gamma(r), Gamma(g), Gamma(b), a);

        private static float Gamma(float c) => c <= 0.0031308f ? 12.92f * c : 1.055f * (float)Math.Pow(c, 1 / 2.4) - 0.055f;
    }

    /// <summary>By rows and columns, m23 the last of the third row.</summary>
    public struct Matrix4x4
    {
        public float m00, m01, m02, m03, m10, m11, m12, m13, m20, m21, m22, m23, m30, m31, m32, m33;

        public static Matrix4x4 identity => TRS(Vector3.zero, Quaternion.identity, Vector3.one);

        public static Matrix4x4 TRS(Vector3 position, Quaternion rotation, Vector3 scale)
        {
            Vector3 x = rotation * Vector3.right * scale.x, y = rotation * Vector3.up * scale.y, z = rotation * Vector3.forward * scale.z;
            return new Matrix4x4
            {
                m00 = x.x, m10 = x.y, m20 = x.z,
                m01 = y.x, m11 = y.y, m21 = y.z,
                m02 = z.x, m12 = z.y, m22 = z.z,
                m03 = position.x, m13 = position.y, m23 = position.z, m33 = 1,
            };
        }

        public Vector3 MultiplyPoint3x4(Vector3 p) => MultiplyVector(p) + new Vector3(m03, m13, m23);

        public Vector3 MultiplyVector(Vector3 v) => new Vector3(
            m00 * v.x + m01 * v.y + m02 * v.z,
            m10 * v.x + m11 * v.y + m12 * v.z,
            m20 * v.x + m21 * v.y + m22 * v.z);

        public static Matrix4x4 operator *(Matrix4x4 a, Matrix4x4 b)
        {
            Vector3 x = a.MultiplyVector(new Vector3(b.m00, b.m10, b.m20)), y = a.MultiplyVector(new Vector3(b.m01, b.m11, b.m21));
            Vector3 z = a.MultiplyVector(new Vector3(b.m02, b.m12, b.m22)), p = a.MultiplyPoint3x4(new Vector3(b.m03, b.m13, b.m23));
            return new Matrix4x4
            {
                m00 = x.x, m10 = x.y, m20 = x.z,
                m01 = y.x, m11 = y.y, m21 = y.z,
                m02 = z.x, m12 = z.y, m22 = z.z,
                m03 = p.x, m13 = p.y, m23 = p.z, m33 = 1,
            };
        }
    }

    public static class Mathf
    {
        public const float PI = (float)Math.PI, Rad2Deg = 180 / PI, Deg2Rad = PI / 180, Infinity = float.PositiveInfinity;

        public static float Min(float a, float b) => a < b ? a : b;

        public static float Max(float a, float b) => a > b ? a : b;

        public static float Abs(float a) => Math.Abs(a);

        public static float Clamp(float value, float min, float max) => Max(min, Min(max, value));

        public static float Clamp01(float value) => Clamp(value, 0, 1);
    }
}
