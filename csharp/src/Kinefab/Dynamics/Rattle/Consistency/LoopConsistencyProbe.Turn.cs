using System;

namespace Kinefab.Dynamics.Rattle;

/// <summary>
/// Tells a loop with axes that are off from a frame that is near a singular pose: both have a velocity that turns the axes apart slowly, and to the
/// letter neither has any other. Axes that are off are so wherever the joints stand: their loop goes round, or as far as joints that the rows hold
/// can go, with angles that give little all the way. What is slow near a singular pose ends beside it: on one side or the other the angles have to
/// give ever more. Such a frame is closed to the letter, and stands. One that goes as far with as little cannot be told from axes that are off.
/// </summary>
internal sealed partial class LoopConsistencyProbe
{
    // How far the joints that the rows hold are moved, each way, in radians or levers' lengths of their fastest: most of a turn in all, and within
    // half a turn, where angles are what they seem.
    private const double HalfTurn = 3;

    // Of the fastest joint at once, and the shortest that is tried where that does not close.
    private const double LongestStride = 0.1;
    private const double ShortestStride = LongestStride / 16;

    // What a stride moves of what it was to move: less, where the angles pull it back; more, where it leaps to another pose.
    private const double LeastMade = 0.5;
    private const double MostMade = 2;

    // Speed of the joints that the rows hold against the fastest joint's, below which they are at the end of their way.
    private const double LeastPace = 0.1;

    // Most that an angle gives on the way, rad: as much as where one axis of a plane loop is tilted by that.
    private const double MostGiven = 0.05;

    private bool IsSlowAllRound(int mixture, bool[] held)
    {
        var start = _motion.Save();
        bool isSlow = true;
        for (int side = -1; side <= 1 && isSlow; side += 2)
        {
            _motion.RestartAllowed(mixture);
            _motion.Scale(side);
            isSlow = IsSlowForHalfATurn(held);
            _motion.Restore(start);
        }

        return isSlow;
    }

    private bool IsSlowForHalfATurn(bool[] held)
    {
        var given = new double[_motion.RowCount];
        double made = 0, stride = LongestStride;
        while (made < HalfTurn)
        {
            _motion.TakeWhatIsHeld();
            double[] rates = _motion.Rates();
            double pace = Pace(rates, held), fastest = LoopMotion.Fastest(rates);
            if (!(pace > LeastPace * fastest))
            {
                return made > 0;
            }

            if (made == 0 && !(_motion.AxesSpeed() <= MostSpeed * pace))
            {
                return false;
            }

            _motion.Scale(1 / fastest);
            double share = TryStride(held, pace / fastest, given, ref stride, out double moved);
            if (!(share >= LeastMade) || !(share <= MostMade))
            {
                return share >= MostMade && made > 0;
            }

            if (!(_motion.AngularError <= MostGiven))
            {
                return false;
            }

            made += moved;
            _motion.Accept(given);
            _motion.Allowed();
        }

        return true;
    }

    // Moves on by the velocities. Returns how far the joints that the rows hold came, of how far they were to come; infinity where the anchors do not
    // close. Out of range only where the shortest stride is.
    private double TryStride(bool[] held, double pace, double[] given, ref double stride, out double moved)
    {
        var before = _motion.Save();
        for (; ; stride /= 2)
        {
            _motion.Scale(stride);
            bool isClosed = _motion.CloseAnchors(given);
            moved = Pace(_motion.Rates(), held);
            double share = isClosed ? moved / (stride * pace) : double.PositiveInfinity;
            if (stride < 2 * ShortestStride || (share >= LeastMade && share <= MostMade))
            {
                stride = Math.Min(LongestStride, 2 * stride);
                return share;
            }

            _motion.Restore(before);
        }
    }

    // Rate of the fastest of the joints that the rows hold.
    private static double Pace(double[] rates, bool[] held)
    {
        double most = 0;
        for (int n = 0; n < rates.Length; n++)
        {
            most = held[n] ? Math.Max(most, rates[n]) : most;
        }

        return most;
    }
}
