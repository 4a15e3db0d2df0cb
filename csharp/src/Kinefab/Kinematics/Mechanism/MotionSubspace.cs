using Kinefab.Joints;
using Kinefab.Numerics;

namespace Kinefab.Kinematics;

/// <summary>
/// What a joint leaves free between its two bodies: up to six twists of the child against its parent, such that a motion
/// along them is finite, not only infinitesimal, wherever the free motions form a group.
/// </summary>
internal static class MotionSubspace
{
    /// <summary>Locked axes of a joint, bit i for <see cref="CoordinateAxis"/> i; 0 for no joint.</summary>
    public static int LockedAxes(JointModel? joint) => joint?.Layout().Locked ?? 0;

    /// <summary>Rows of a joint's locked axes.</summary>
    public static int Rows(JointModel joint) => 6 - Count(LockedAxes(joint));

    /// <summary>Number of freedoms.</summary>
    public static int Count(int lockedAxes)
    {
        int count = 6;
        for (int i = 0; i < 6; i++)
        {
            count -= (lockedAxes >> i) & 1;
        }

        return count;
    }

    /// <summary>Directions of the freedoms of a body without a joint: the translations, then the rotations about its own origin.</summary>
    /// <returns>Number of translations.</returns>
    public static int Free(Vector3d[] axes, int at)
    {
        for (int i = 0; i < 3; i++)
        {
            axes[at + i] = axes[at + 3 + i] = Unit(i);
        }

        return 3;
    }

    /// <summary>
    /// Directions of a joint's freedoms in the world: first the translations, then the rotations about frame 1's origin.
    /// With one angular axis locked the two rotations are those that keep its equation (see D6Joint's LockedAxes): X1 and
    /// Z0 or Y0 for a swing, all that is at right angles to the quaternion's row for the twist.
    /// </summary>
    /// <returns>Number of translations.</returns>
    public static int Directions(int lockedAxes, in JointFrames f, Vector3d[] axes, int at)
    {
        int count = 0;
        for (int i = 0; i < 3; i++)
        {
            if ((lockedAxes & (1 << i)) == 0)
            {
                axes[at + count++] = f.Axis0(i);
            }
        }

        int translations = count;
        int angular = lockedAxes >> 3;
        switch (angular)
        {
            case 0b001:
                JointFrames.QuaternionAxes(f.Q0, f.Q1, out Vector3d row, out _, out _);
                Vector3d unit = row.Normalized();
                Vector3d side = Vector3d.Perpendicular(unit);
                axes[at + count] = side;
                axes[at + count + 1] = Vector3d.Cross(unit, side);
                break;
            case 0b010:
            case 0b100:
                f.Axes1(out Vector3d x1, out _, out _);
                axes[at + count] = x1;
                axes[at + count + 1] = f.Axis0(angular == 0b010 ? 2 : 1);
                break;
            default:
                for (int i = 0; i < 3; i++)
                {
                    if ((angular & (1 << i)) == 0)
                    {
                        axes[at + count++] = f.Axis0(i);
                    }
                }

                break;
        }

        return translations;
    }

    private static Vector3d Unit(int i) => i == 0 ? Vector3d.UnitX : i == 1 ? Vector3d.UnitY : Vector3d.UnitZ;
}
