using Kinefab.Numerics;
using UnityEngine;

namespace KinefabUnity
{
    /// <summary>From the file's numbers to Unity's, and back; frame and units are Unity's already.</summary>
    internal static class Numbers
    {
        // As Unity's Inspector has it: PhysX refuses a drive whose largest force is infinite.
        private const float Unlimited = 3.4028233e38f;

        internal static Vector3 Vector(Vector3d v) => new Vector3((float)v.X, (float)v.Y, (float)v.Z);

        internal static Vector2 Vector(Vector2d v) => new Vector2((float)v.X, (float)v.Y);

        internal static Vector3d Vector(Vector3 v) => new Vector3d(v.x, v.y, v.z);

        // The file's quaternions may be off unit length by 1e-4, which Unity says is no rotation.
        internal static Quaternion Rotation(Quaterniond q)
        {
            Quaterniond unit = q.Normalized();
            return new Quaternion((float)unit.X, (float)unit.Y, (float)unit.Z, (float)unit.W);
        }

        internal static Quaterniond Rotation(Quaternion q) => new Quaterniond(q.x, q.y, q.z, q.w).Normalized();

        internal static float Force(double value) => value > Unlimited ? Unlimited : (float)value;
    }
}
