using Kinefab.Document;
using Kinefab.Joints;

namespace Kinefab.Kinematics;

/// <summary>Names a row's limit as Unity's user knows it.</summary>
internal static class LimitNames
{
    /// <summary>The limit, with its end read from the state where the limit is symmetric.</summary>
    public static ReachedLimit? Of(MechanismState state, LimitSet limits, int limit)
    {
        Mechanism mechanism = state.Mechanism;
        int joint = limits.JointOf(limit);
        LimitSide side = LimitSet.SideOf(limit);
        for (int i = 0; i < mechanism.Coordinates.Count; i++)
        {
            MechanismCoordinate c = mechanism.Coordinates[i];
            if (c.Joint == joint && IsMeant(c, side))
            {
                // Rows measure actor 1 against actor 0, coordinates mostly the other way round.
                bool isUpper = side switch
                {
                    LimitSide.TwistLower => !c.IsAlongRows,
                    LimitSide.TwistUpper => c.IsAlongRows,
                    _ => state.Values[i] > 0,
                };
                return new ReachedLimit(c.GameObject, c.Component, c.Coordinate, isUpper);
            }
        }

        return null;
    }

    private static bool IsMeant(MechanismCoordinate c, LimitSide side)
    {
        if (c.JointRows is not D6Joint d6)
        {
            return true;
        }

        return side switch
        {
            LimitSide.TwistLower or LimitSide.TwistUpper => c.Coordinate == Coordinate.AngularX,
            LimitSide.Linear => (c.Coordinate == Coordinate.X && d6.X == AxisMotion.Limited)
                || (c.Coordinate == Coordinate.Y && d6.Y == AxisMotion.Limited)
                || (c.Coordinate == Coordinate.Z && d6.Z == AxisMotion.Limited),
            _ => (c.Coordinate == Coordinate.AngularY && d6.Swing1 == AxisMotion.Limited)
                || (c.Coordinate == Coordinate.AngularZ && d6.Swing2 == AxisMotion.Limited),
        };
    }
}
