namespace Kinefab.Joints;

/// <summary>What a joint axis may do; PxD6Motion and ConfigurableJointMotion have the same values.</summary>
internal enum AxisMotion : byte
{
    Locked = 0,
    Limited = 1,
    Free = 2,
}
