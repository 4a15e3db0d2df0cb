using System;
using System.Collections.Generic;
using Kinefab.Numerics;
using UnityEngine;
using UnityEngine.Events;

namespace KinefabUnity
{
    /// <summary>
    /// Moves the parts of an imported scene as their joints let them, loops and couplings closed to rounding: by sliders in the
    /// inspector, by the mouse (<see cref="KinefabDragger"/>) and by scripts. Values are the source's, degrees and metres.
    /// </summary>
    /// <example><code>
    /// var mechanism = GetComponent&lt;KinefabMechanism&gt;();
    /// mechanism.Drive("Shaft", 60);
    /// Debug.Log(mechanism.Value("Slide"));
    /// </code></example>
    [ExecuteAlways]
    [DisallowMultipleComponent]
    [AddComponentMenu("Kinefab/Kinefab Mechanism")]
    public sealed partial class KinefabMechanism : MonoBehaviour, ISerializationCallbackReceiver
    {
        /// <summary>A joint's limit is met; told once, with the name of the coordinate that is limited.</summary>
        public UnityEvent<string> onLimit = new UnityEvent<string>();

        /// <summary>A drive ends at a dead point; told once, with the name of the driven coordinate.</summary>
        public UnityEvent<string> onDeadPoint = new UnityEvent<string>();

        /// <summary>Several ways led on and the straightest was taken; told with the name of the driven coordinate.</summary>
        public UnityEvent<string> onBranch = new UnityEvent<string>();

        private static readonly List<KinefabMechanism> Enabled = new List<KinefabMechanism>();

        private readonly Dictionary<Transform, int> _places = new Dictionary<Transform, int>();

        [SerializeField] private KinefabSource source;
        [SerializeField] private Transform[] parts = Array.Empty<Transform>();
        [SerializeField] private KinefabFreedom[] freedoms = Array.Empty<KinefabFreedom>();
        [SerializeField] private int[] carriers = Array.Empty<int>();
        [SerializeField] private int[] islands = Array.Empty<int>();
        [SerializeField] private string problem = "";
        [SerializeField] private KinefabMover mover = KinefabMover.Exact;
        [SerializeField] private string pose = "";
        [SerializeField] private double[] values = Array.Empty<double>();
        [SerializeField] private string[] valuesOf = Array.Empty<string>();

        [NonSerialized] private MotionState _motion;
        [NonSerialized] private PartPlacement _placement;
        [NonSerialized] private JointTargets _targets;
        [NonSerialized] private string _fault;
        [NonSerialized] private string _version;
        [NonSerialized] private int _packedMoves;
        [NonSerialized] private Transform[] _placesOf;
        [NonSerialized] private bool _isStale;
        [NonSerialized] private bool _isLetGo;
        [NonSerialized] private bool _wasSwitchedOff;
        [NonSerialized] private KinefabStop _lastStop;
        [NonSerialized] private string _lastLimit;

        /// <summary>Mechanisms that are switched on, for what picks among them.</summary>
        public static IReadOnlyList<KinefabMechanism> All => Enabled;

        /// <summary>Its freedoms, in the order that <see cref="Set"/> takes values.</summary>
        public IReadOnlyList<KinefabFreedom> Freedoms => freedoms;

        /// <summary>Why nothing moves, for people; empty: all is well.</summary>
        public string Problem => _fault ?? problem;

        /// <summary>What it was made of: what was found about the file, and the project settings that it was made for; null: it is gone.</summary>
        public KinefabSource Source => source;

        /// <summary>What came of the last drive or drag.</summary>
        public KinefabResult Last { get; private set; }

        /// <summary>What moves the parts while the game plays; a change hands the parts over where they stand and as fast as they go.</summary>
        public KinefabMover Mover
        {
            get => mover;
            set
            {
                if (value == mover)
                {
                    return;
                }

                bool isLive = isActiveAndEnabled && Application.isPlaying;
                if (isLive)
                {
                    Release();
                }

                mover = value;
                if (isLive)
                {
                    Take();
                }
            }
        }

        /// <summary>A coordinate as the source shows it, degrees (over any number of turns) or metres.</summary>
        /// <param name="coordinate">Name of a freedom or of any other joint: Shaft, Slide, Lever/Crank:1.angle.</param>
        /// <exception cref="ArgumentException">None answers to the name, or several do: the message says which there are.</exception>
        public double Value(string coordinate) => IsReady() ? _motion.Value(_motion.Mechanism.CoordinateNamed(coordinate)) : 0;

        /// <summary>A freedom as the source shows it.</summary>
        /// <param name="freedom">Index into <see cref="Freedoms"/>.</param>
        public double Value(int freedom) => IsReady() ? _motion.Value(freedoms[freedom].Coordinate) : 0;

        /// <summary>Moves a coordinate to a value and everything else with it, as far as limits and dead points let it.</summary>
        /// <param name="coordinate">Name of a freedom or of any other joint: Shaft, Slide, Lever/Crank:1.angle.</param>
        /// <param name="value">As the source shows it, degrees or metres.</param>
        /// <exception cref="ArgumentException">None answers to the name, or several do (the message says which there are), or the value is no finite number.</exception>
        public KinefabResult Drive(string coordinate, double value) =>
            IsReady() ? Moved(_motion.Mechanism.CoordinateNamed(coordinate), value) : Nothing();

        /// <summary>Moves a freedom to a value and everything else with it, as far as limits and dead points let it.</summary>
        /// <param name="freedom">Index into <see cref="Freedoms"/>.</param>
        /// <param name="value">As the source shows it, degrees or metres.</param>
        /// <exception cref="ArgumentException">The value is no finite number.</exception>
        public KinefabResult Drive(int freedom, double value) => IsReady() ? Moved(freedoms[freedom].Coordinate, value) : Nothing();

        /// <summary>Moves all freedoms to values together.</summary>
        /// <param name="shown">One for each of <see cref="Freedoms"/>, as the source shows it.</param>
        /// <exception cref="ArgumentException">There are more or fewer freedoms, or a value is no finite number.</exception>
        public KinefabResult Set(ReadOnlySpan<double> shown) => IsReady() ? Told(_motion.Set(shown), null) : Nothing();

        /// <summary>Pulls a point of a part towards a place as far as joints and limits let it.</summary>
        /// <param name="part">A part that moves, or anything on one.</param>
        /// <param name="localPoint">In its own frame, as <c>Transform.InverseTransformPoint</c> gives it.</param>
        /// <param name="worldTarget">In the world.</param>
        /// <exception cref="ArgumentException">The part is none of this mechanism's that move, or a number is not finite.</exception>
        public KinefabResult Drag(Transform part, Vector3 localPoint, Vector3 worldTarget)
        {
            if (!IsReady())
            {
                return Nothing();
            }

            int index = CarrierOf(part, out Transform carrier);
            if (index < 0)
            {
                throw new ArgumentException("No body of this mechanism moves " + (part == null ? "nothing" : part.name) + ".", nameof(part));
            }

            // A point on a part that hangs below the body is one of the body's.
            Vector3 own = carrier == part ? localPoint : carrier.InverseTransformPoint(part.TransformPoint(localPoint));
            Vector3d point = Vector3d.Scale(_motion.Mechanism.Scene.WorldTransform(index).Scale, Numbers.Vector(own));
            return Told(_motion.Drag(index, point, Numbers.Vector(transform.InverseTransformPoint(worldTarget))), null);
        }

        /// <summary>Whether a body of this mechanism that can move carries a part.</summary>
        public bool CanDrag(Transform part) => CarrierOf(part, out _) >= 0;

        /// <summary>Back to the pose in the file.</summary>
        public void GoHome()
        {
            if (IsReady())
            {
                _motion.GoHome();
                Told(default, null);
            }
        }

        /// <summary>Gives the component its scene and parts: the importer's last word.</summary>
        /// <param name="from">The scene.</param>
        /// <param name="objects">The made objects in the order of the file.</param>
        internal void Bind(KinefabSource from, Transform[] objects)
        {
            source = from;
            parts = objects;
            pose = "";
            problem = "";
            freedoms = Array.Empty<KinefabFreedom>();
            carriers = new int[objects.Length];
            Array.Fill(carriers, -1);
            Forget();
            if (!IsReady())
            {
                problem = _fault;
                return;
            }

            var scene = _motion.Mechanism.Scene;
            for (int i = 0; i < carriers.Length; i++)
            {
                carriers[i] = scene.BodyOf(i) is int body && !scene.Body(body).IsKinematic ? body : -1;
            }

            islands = FreedomFinder.Islands(_motion.Mechanism);
            freedoms = FreedomFinder.Find(_motion.Mechanism, islands);
            problem = freedoms.Length > 0 ? "" : "No joint of this scene can move.";
            Forget();
            if (isActiveAndEnabled && Application.isPlaying)
            {
                Take();
            }
        }

        /// <summary>The object of an index of the file; null: there is none, or no more.</summary>
        internal Transform Part(int gameObject) => (uint)gameObject < (uint)parts.Length ? parts[gameObject] : null;

        /// <summary>The parts that bodies move, those that are there.</summary>
        internal IEnumerable<Transform> MovingParts()
        {
            for (int i = 0; i < parts.Length; i++)
            {
                if (parts[i] != null && i < carriers.Length && carriers[i] == i)
                {
                    yield return parts[i];
                }
            }
        }

        /// <summary>The island of the body that carries a part; -1: none.</summary>
        internal int IslandOf(Transform part)
        {
            int body = CarrierOf(part, out _);
            return body >= 0 && body < islands.Length ? islands[body] : -1;
        }

        internal MotionState Motion => IsReady() ? _motion : null;

        // Made anew where Unity has given the component other parts.
        private Dictionary<Transform, int> Places()
        {
            if (!ReferenceEquals(_placesOf, parts))
            {
                _placesOf = parts;
                _places.Clear();
                for (int i = parts.Length - 1; i >= 0; i--)
                {
                    if (parts[i] != null)
                    {
                        _places[parts[i]] = i;
                    }
                }
            }

            return _places;
        }

        // The part that a body moves, on or above a Transform.
        private int CarrierOf(Transform part, out Transform carrier)
        {
            for (Transform at = part; at != null; at = at.parent)
            {
                if (Places().TryGetValue(at, out int index))
                {
                    int body = carriers[index];
                    carrier = body >= 0 ? parts[body] : null;
                    return carrier == null ? -1 : body;
                }
            }

            carrier = null;
            return -1;
        }

        private KinefabResult Moved(int coordinate, double value) => Told(_motion.Drive(coordinate, value), _motion.Mechanism.Coordinates[coordinate].ShortName);

        private KinefabResult Nothing() => Last = new KinefabResult(KinefabStop.NoMechanism, 0, 0, null, false);

        private KinefabResult Told(in KinefabResult result, string driven)
        {
            Last = result;
            Show();
            bool isNew = result.Stop != _lastStop || !string.Equals(result.Limit, _lastLimit, StringComparison.Ordinal);
            _lastStop = result.Stop;
            _lastLimit = result.Limit;
            if (isNew && result.Stop == KinefabStop.Limit)
            {
                onLimit.Invoke(result.Limit ?? "");
            }
            else if (isNew && result.Stop == KinefabStop.DeadPoint)
            {
                onDeadPoint.Invoke(driven ?? "");
            }

            if (result.Branches > 1)
            {
                onBranch.Invoke(driven ?? "");
            }

            return result;
        }
    }
}
