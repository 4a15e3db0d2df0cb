using System;
using System.Collections.Generic;
using Kinefab.Kinematics;
using Kinefab.Numerics;
using Kinefab.Validation;

namespace KinefabUnity
{
    /// <summary>The mechanism of a scene and where it stands: in doubles, without a line of Unity. After its first moves it allocates nothing.</summary>
    internal sealed class MotionState
    {
        private readonly PositionSolver _solver;
        private readonly CoordinateTarget[] _targets;
        private readonly int[] _freedoms;
        private readonly double[] _numbers;
        private readonly ulong _scene;

        /// <summary>At the exported pose.</summary>
        /// <param name="scene">A valid one.</param>
        /// <param name="freedoms">The coordinates that <see cref="Set"/> takes values of; null: none.</param>
        public MotionState(ValidScene scene, int[] freedoms)
        {
            Mechanism = Mechanism.Create(scene);
            _solver = new PositionSolver(Mechanism);
            State = Mechanism.NewState();
            Home = Mechanism.NewState();
            _freedoms = freedoms ?? Array.Empty<int>();
            _targets = new CoordinateTarget[_freedoms.Length];
            _numbers = new double[State.NumberCount];
            State.CopyTo(_numbers);
            _scene = HashOf(_numbers);
        }

        public Mechanism Mechanism { get; }

        public MechanismState State { get; }

        /// <summary>The exported pose.</summary>
        public MechanismState Home { get; }

        /// <summary>Grows with each move.</summary>
        public int Moves { get; private set; }

        /// <summary>As the source shows it.</summary>
        public double Value(int coordinate) => Mechanism.Coordinates[coordinate].ToCad(State.Coordinate(coordinate));

        /// <summary>Moves one coordinate to a value that the source would show.</summary>
        public KinefabResult Drive(int coordinate, double shown)
        {
            Moves++;
            return Told(_solver.Drive(State, coordinate, Mechanism.Coordinates[coordinate].FromCad(shown)), KinefabStop.DeadPoint);
        }

        /// <summary>Moves all freedoms together.</summary>
        public KinefabResult Set(ReadOnlySpan<double> shown)
        {
            if (shown.Length != _targets.Length)
            {
                throw new ArgumentException("There are " + _targets.Length + " freedoms.", nameof(shown));
            }

            for (int i = 0; i < _targets.Length; i++)
            {
                _targets[i] = new CoordinateTarget(_freedoms[i], Mechanism.Coordinates[_freedoms[i]].FromCad(shown[i]));
            }

            Moves++;
            return Told(_solver.Drive(State, _targets), KinefabStop.DeadPoint);
        }

        /// <summary>Moves coordinates together, those that there are.</summary>
        /// <param name="fullNames">Lever/Crank:1.angle.</param>
        /// <param name="shown">One for each, as the source shows it.</param>
        public void Set(string[] fullNames, double[] shown)
        {
            var targets = new List<CoordinateTarget>();
            for (int i = 0; i < Mechanism.Coordinates.Count; i++)
            {
                int at = Array.IndexOf(fullNames, Mechanism.Coordinates[i].Name);
                if (at >= 0)
                {
                    targets.Add(new CoordinateTarget(i, Mechanism.Coordinates[i].FromCad(shown[at])));
                }
            }

            Moves++;
            _solver.Drive(State, targets.ToArray());
        }

        /// <summary>Pulls a point of a GameObject to a place.</summary>
        /// <param name="gameObject">One that a body moves.</param>
        /// <param name="point">In its own unscaled frame, metres.</param>
        /// <param name="target">In the scene's frame, metres.</param>
        public KinefabResult Drag(int gameObject, Vector3d point, Vector3d target)
        {
            Moves++;
            return Told(_solver.Drag(State, gameObject, point, target), KinefabStop.OutOfReach);
        }

        /// <summary>Takes over poses of bodies, from physics or from hands, and closes the joints.</summary>
        public void Follow(ReadOnlySpan<int> gameObjects, ReadOnlySpan<Pose> poses, bool closes)
        {
            State.SetPoses(gameObjects, poses);
            if (closes)
            {
                _solver.Close(State);
            }

            Moves++;
        }

        /// <summary>Back to the pose in the file.</summary>
        public void GoHome()
        {
            State.CopyFrom(Home);
            Moves++;
        }

        /// <summary>Everything that a later drive depends on, as text: which scene, and the state to the last bit.</summary>
        public string Pack()
        {
            State.CopyTo(_numbers);
            var bytes = new byte[8 + 8 * _numbers.Length];
            BitConverter.GetBytes(_scene).CopyTo(bytes, 0);
            Buffer.BlockCopy(_numbers, 0, bytes, 8, 8 * _numbers.Length);
            return Convert.ToBase64String(bytes);
        }

        /// <summary>Takes over what <see cref="Pack"/> gave. False: it is of another scene, or no such text; nothing has changed then.</summary>
        public bool TryUnpack(string text)
        {
            try
            {
                byte[] bytes = Convert.FromBase64String(text);
                if (bytes.Length != 8 + 8 * _numbers.Length || BitConverter.ToUInt64(bytes, 0) != _scene)
                {
                    return false;
                }

                Buffer.BlockCopy(bytes, 8, _numbers, 0, 8 * _numbers.Length);
                State.CopyFrom(new ReadOnlySpan<double>(_numbers));
            }
            catch (Exception fault) when (fault is FormatException || fault is ArgumentException)
            {
                return false;
            }

            Moves++;
            return true;
        }

        private KinefabResult Told(in DriveResult result, KinefabStop beyond)
        {
            KinefabStop stop = result.Status switch
            {
                DriveStatus.Reached => KinefabStop.None,
                DriveStatus.StoppedByLimit => KinefabStop.Limit,
                DriveStatus.OutOfReach => beyond,
                _ => KinefabStop.NotClosed,
            };
            if (!(result.Limit is ReachedLimit limit))
            {
                return new KinefabResult(stop, result.Fraction, result.Branches, null, false);
            }

            int coordinate = Mechanism.FindCoordinate(limit.GameObject, limit.Component, limit.Coordinate);
            return new KinefabResult(stop, result.Fraction, result.Branches, coordinate < 0 ? "" : Mechanism.Coordinates[coordinate].ShortName, limit.IsUpper);
        }

        // FNV-1a over the bits of the exported pose.
        private static ulong HashOf(double[] numbers)
        {
            ulong hash = 14695981039346656037;
            foreach (double number in numbers)
            {
                ulong bits = (ulong)BitConverter.DoubleToInt64Bits(number);
                for (int i = 0; i < 64; i += 8)
                {
                    hash = unchecked((hash ^ ((bits >> i) & 255)) * 1099511628211);
                }
            }

            return hash;
        }
    }
}
