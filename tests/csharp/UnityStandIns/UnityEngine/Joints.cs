namespace UnityEngine
{
    public enum ConfigurableJointMotion
    {
        Locked = 0,
        Limited = 1,
        Free = 2,
    }

    public enum RotationDriveMode
    {
        XYAndZ = 0,
        Slerp = 1,
    }

    public enum JointProjectionMode
    {
        None = 0,
        PositionAndRotation = 1,
    }

    public struct JointSpring
    {
        public float spring, damper, targetPosition;
    }

    public struct JointMotor
    {
        public float targetVelocity { get; set; }

        public float force { get; set; }

        public bool freeSpin { get; set; }
    }

    public struct JointLimits
    {
        public float min { get; set; }

        public float max { get; set; }

        public float bounciness { get; set; }

        public float bounceMinVelocity { get; set; }

        public float contactDistance { get; set; }
    }

    public struct SoftJointLimit
    {
        public float limit { get; set; }

        public float bounciness { get; set; }

        public float contactDistance { get; set; }
    }

    public struct SoftJointLimitSpring
    {
        public float spring { get; set; }

        public float damper { get; set; }
    }

    public struct JointDrive
    {
        public float positionSpring { get; set; }

        public float positionDamper { get; set; }

        public float maximumForce { get; set; }

#if UNITY_2022_2_OR_NEWER
        public bool useAcceleration { get; set; }
#endif
    }

    public partial class Joint : Component
    {
        private Rigidbody _connectedBody;
        private ArticulationBody _connectedArticulationBody;
        private Vector3 _anchor = new Vector3(0, 0.5f, 0);
        private Vector3 _connectedAnchor;
        private bool _isConfigured = true;

        public Rigidbody connectedBody
        {
            get => _connectedBody;
            set
            {
                _connectedBody = value;
                Configure();
            }
        }

        public ArticulationBody connectedArticulationBody
        {
            get => _connectedArticulationBody;
            set
            {
                _connectedArticulationBody = value;
                Configure();
            }
        }

        public Vector3 axis { get; set; } = new Vector3(1, 0, 0);

        public Vector3 anchor
        {
            get => _anchor;
            set
            {
                _anchor = value;
                Configure();
            }
        }

        public Vector3 connectedAnchor
        {
            get => _connectedAnchor;
            set
            {
                _connectedAnchor = value;
                Configure();
            }
        }

        public bool autoConfigureConnectedAnchor
        {
            get => _isConfigured;
            set
            {
                _isConfigured = value;
                Configure();
            }
        }

        public float breakForce { get; set; } = float.PositiveInfinity;

        public float breakTorque { get; set; } = float.PositiveInfinity;

        public bool enableCollision { get; set; }

        public bool enablePreprocessing { get; set; } = true;

        public float massScale { get; set; } = 1;

        public float connectedMassScale { get; set; } = 1;

        internal void Made() => Configure();

        /// <summary>Pose of its body against the connected one, as PhysX had them when it made the joint; null: it has none.</summary>
        internal (Vector3 Position, Quaternion Rotation)? MadeAt { get; private set; }

        /// <summary>PhysX makes a joint when its object is switched on, and gives it up with it.</summary>
        internal void Renew()
        {
            if (!gameObject.activeInHierarchy)
            {
                MadeAt = null;
            }
            else if (MadeAt == null)
            {
                (Vector3 at, Quaternion turn) = (Vector3.zero, Quaternion.identity);
                if (_connectedBody != null)
                {
                    (at, turn) = _connectedBody.InPhysics ?? (_connectedBody.transform.position, _connectedBody.transform.rotation);
                }

                Quaternion back = Quaternion.Inverse(turn);
                MadeAt = (back * (transform.position - at), back * transform.rotation);
            }
        }

        // Unity works the anchor out where it is asked to, whatever was set before: where the own anchor stands, seen from the connected body.
        private void Configure()
        {
            if (!_isConfigured)
            {
                return;
            }

            Transform connected = _connectedBody != null ? _connectedBody.transform : _connectedArticulationBody != null ? _connectedArticulationBody.transform : null;
            Vector3 own = transform.TransformPoint(_anchor);
            _connectedAnchor = connected == null ? own : connected.InverseTransformPoint(own);
        }
    }

    public sealed class FixedJoint : Joint
    {
    }

    public sealed class HingeJoint : Joint
    {
        public JointSpring spring { get; set; }

        public bool useSpring { get; set; }

        public JointMotor motor { get; set; }

        public bool useMotor { get; set; }

        public JointLimits limits { get; set; }

        public bool useLimits { get; set; }

#if UNITY_2022_2_OR_NEWER
        public bool extendedLimits { get; set; }

        public bool useAcceleration { get; set; }
#endif
    }

    public sealed class ConfigurableJoint : Joint
    {
        public Vector3 secondaryAxis { get; set; } = new Vector3(0, 1, 0);

        public ConfigurableJointMotion xMotion { get; set; } = ConfigurableJointMotion.Free;

        public ConfigurableJointMotion yMotion { get; set; } = ConfigurableJointMotion.Free;

        public ConfigurableJointMotion zMotion { get; set; } = ConfigurableJointMotion.Free;

        public ConfigurableJointMotion angularXMotion { get; set; } = ConfigurableJointMotion.Free;

        public ConfigurableJointMotion angularYMotion { get; set; } = ConfigurableJointMotion.Free;

        public ConfigurableJointMotion angularZMotion { get; set; } = ConfigurableJointMotion.Free;

        public SoftJointLimitSpring linearLimitSpring { get; set; }

        public SoftJointLimit linearLimit { get; set; }

        public SoftJointLimitSpring angularXLimitSpring { get; set; }

        public SoftJointLimit lowAngularXLimit { get; set; }

        public SoftJointLimit highAngularXLimit { get; set; }

        public SoftJointLimitSpring angularYZLimitSpring { get; set; }

        public SoftJointLimit angularYLimit { get; set; }

        public SoftJointLimit angularZLimit { get; set; }

        public Vector3 targetPosition { get; set; }

        public Vector3 targetVelocity { get; set; }

        public JointDrive xDrive { get; set; }

        public JointDrive yDrive { get; set; }

        public JointDrive zDrive { get; set; }

        public Quaternion targetRotation { get; set; } = new Quaternion(0, 0, 0, 1);

        public Vector3 targetAngularVelocity { get; set; }

        public RotationDriveMode rotationDriveMode { get; set; }

        public JointDrive angularXDrive { get; set; }

        public JointDrive angularYZDrive { get; set; }

        public JointDrive slerpDrive { get; set; }

        public JointProjectionMode projectionMode { get; set; }

        public float projectionDistance { get; set; } = 0.1f;

        public float projectionAngle { get; set; } = 180;

        public bool configuredInWorldSpace { get; set; }

        public bool swapBodies { get; set; }
    }
}
