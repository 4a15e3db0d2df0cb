using System;
using Kinefab.Numerics;

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

    // Iterations in which angles yield as well before anchors are closed alone, and in all.
    private const int Yieldings = 3;
    private const int MostClosings = 20;

    // Gap of the anchors that counts as closed, against the levers' length.
    private const double MostGap = 1e-6;

    private bool IsSlowAllRound(int mixture, bool[] held)
    {
        var start = (double[])_batch.Bodies.Clone();
        bool isSlow = true;
        for (int side = -1; side <= 1 && isSlow; side += 2)
        {
            RestartAllowed(mixture);
            Scale(side);
            isSlow = IsSlowForHalfATurn(held);
            Array.Copy(start, _batch.Bodies, start.Length);
        }

        return isSlow;
    }

    private bool IsSlowForHalfATurn(bool[] held)
    {
        var given = new double[_batch.Work.Error.Length];
        double made = 0, stride = LongestStride;
        while (made < HalfTurn)
        {
            TakeWhatIsHeld();
            double[] rates = Rates();
            double pace = Pace(rates, held), fastest = Fastest(rates);
            if (!(pace > LeastPace * fastest))
            {
                return made > 0;
            }

            Impulses<ScalarLane>.NegativeSpeeds(_batch, false);
            if (made == 0 && !(MostAngular(_batch.Work.Solution) <= MostSpeed * pace))
            {
                return false;
            }

            Scale(1 / fastest);
            double share = TryStride(held, pace / fastest, given, ref stride, out double moved);
            if (!(share >= LeastMade) || !(share <= MostMade))
            {
                return share >= MostMade && made > 0;
            }

            if (!(AngularError() <= MostGiven))
            {
                return false;
            }

            made += moved;
            Array.Copy(_batch.Work.Error, given, given.Length);
            RattleStep<ScalarLane>.Accept(_batch);
            Allowed();
        }

        return true;
    }

    // Moves on by the velocities. Returns how far the joints that the rows hold came, of how far they were to come; infinity where the anchors do not
    // close. Out of range only where the shortest stride is.
    private double TryStride(bool[] held, double pace, double[] given, ref double stride, out double moved)
    {
        var before = (double[])_batch.Bodies.Clone();
        for (; ; stride /= 2)
        {
            Scale(stride);
            bool isClosed = CloseAnchors(given);
            moved = Pace(Rates(), held);
            double share = isClosed ? moved / (stride * pace) : double.PositiveInfinity;
            if (stride < 2 * ShortestStride || (share >= LeastMade && share <= MostMade))
            {
                stride = Math.Min(LongestStride, 2 * stride);
                return share;
            }

            Array.Copy(before, _batch.Bodies, before.Length);
        }
    }

    // Leaves of the velocities what the rows would not allow to the letter.
    private void TakeWhatIsHeld()
    {
        var all = (double[])_batch.Bodies.Clone();
        TakeToTheLetter(true);
        TakeFrom(all);
    }

    // The velocities become what they lack of others.
    private void TakeFrom(double[] all)
    {
        for (int body = 0; body < _batch.Shape.MovingBodies; body++)
        {
            int o = LaneBatch<ScalarLane>.Body(body, BodyLanes.V);
            for (int i = o; i < o + 6; i++)
            {
                _batch.Bodies[i] = all[i] - _batch.Bodies[i];
            }
        }
    }

    // Moves the bodies by their velocities, which become those that lead to where the anchors are closed. Of the angles only what the stride adds to
    // what they had given yields: all of it would lead back to the start, the farther the shorter the strides are.
    private bool CloseAnchors(double[] given)
    {
        for (int i = 0; ; i++)
        {
            FreeMotion<ScalarLane>.Drift(_batch, 1);
            BilateralRows<ScalarLane>.Evaluate(_batch);
            BilateralRows<ScalarLane>.MeasureErrors(_batch);
            Rebuild();
            bool isClosed = _batch.Work.MaxGap[0] <= MostGap * _length;
            if ((isClosed && i >= Yieldings) || i == MostClosings)
            {
                return isClosed;
            }

            for (int row = 0; row < given.Length; row++)
            {
                double error = _batch.Work.Error[row];
                _batch.Work.Solution[row] = !_batch.Shape.IsAngular[row] ? -error : i < Yieldings ? given[row] - error : 0;
            }

            DelassusMatrix<ScalarLane>.Solve(_batch, _batch.Work.Solution);
            Impulses<ScalarLane>.Apply(_batch, _batch.Work.Solution);
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
