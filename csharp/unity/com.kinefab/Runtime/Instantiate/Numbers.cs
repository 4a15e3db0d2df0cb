using Kinefab.Numerics;
using UnityEngine;

namespace KinefabUnity
{
    /// <summary>From the file's numbers to Unity's; frame and units are Unity's already.</summary>
    internal static class Numbers
    {
        // As Unity's Inspector has it: PhysX refuses a drive whose largest force is infinite.
        private const float Unlimited = 3.4028233e38f;

        internal static Vector3 Vector(Vector3d v) => new Vector3((float)v.X, (float)v.Y, (float)v.Z);

        // The file's quaternions may be off unit length by 1e-4, which Unity says is no rotation.
        internal static Quaternion Rotation(Quaterniond q)
        {
            Quaterniond unit = q.Normalized();
            return new Quaternion((float)unit.X, (float)unit.Y, (float)unit.Z, (float)unit.W);
        }

        internal static float Force(double value) => value > Unlimited ? Unlimited : (float)value;
    }
}
