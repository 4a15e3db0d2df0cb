using System;
using UnityEngine;

namespace KinefabUnity
{
    /// <summary>One freedom of a mechanism, as a slider shows it: in the source's name, sense and zero; degrees or metres.</summary>
    [Serializable]
    public sealed class KinefabFreedom
    {
        [SerializeField] private string name = "";
        [SerializeField] private string fullName = "";
        [SerializeField] private int coordinate;
        [SerializeField] private bool isAngle;
        [SerializeField] private double low;
        [SerializeField] private double high;
        [SerializeField] private bool isOpenBelow;
        [SerializeField] private bool isOpenAbove;
        [SerializeField] private int island;

        // For Unity, which makes one before it reads the fields.
        private KinefabFreedom()
        {
        }

        internal KinefabFreedom(string name, string fullName, int coordinate, bool isAngle, int island)
        {
            this.name = name;
            this.fullName = fullName;
            this.coordinate = coordinate;
            this.isAngle = isAngle;
            this.island = island;
        }

        /// <summary>What the source calls the joint, Shaft; else the id of the object that carries it. <c>Drive</c> takes it.</summary>
        public string Name => name;

        /// <summary>Lever/Crank:1.angle: no other freedom answers to it.</summary>
        public string FullName => fullName;

        /// <summary>Degrees when true, metres when false.</summary>
        public bool IsAngle => isAngle;

        /// <summary>deg or m.</summary>
        public string Unit => isAngle ? "deg" : "m";

        /// <summary>Least value from the exported pose, where another joint's limit or a dead point may be what ends it.</summary>
        public double Low => low;

        /// <summary>Largest value from the exported pose.</summary>
        public double High => high;

        /// <summary>Nothing ends it below: Low is what a slider shows.</summary>
        public bool IsOpenBelow => isOpenBelow;

        /// <summary>Nothing ends it above: High is what a slider shows.</summary>
        public bool IsOpenAbove => isOpenAbove;

        /// <summary>Number of the island, the bodies that hang together by joints.</summary>
        public int Island => island;

        internal int Coordinate => coordinate;

        internal void SetRange(double lowest, bool openBelow, double highest, bool openAbove)
        {
            low = lowest;
            high = highest;
            isOpenBelow = openBelow;
            isOpenAbove = openAbove;
        }
    }
}
