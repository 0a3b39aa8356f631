#nullable enable
using HaptoFlow.Numerics;

namespace HaptoFlow.Contact
{
    /// <summary>How unevenly places follow each other: the sum of the squares of the changes of velocity between them, in
    /// (m/s)^2.</summary>
    internal struct Roughness
    {
        private double seconds;
        private Double3 place;
        private Double3 velocity;

        /// <summary>Places so far.</summary>
        public int Count { get; private set; }

        public double Squares { get; private set; }

        /// <summary>Adds a place, later than the last.</summary>
        public void Add(double timeSeconds, Double3 placeMetres)
        {
            if (Count > 0)
            {
                Double3 now = (placeMetres - place) / (timeSeconds - seconds);
                Squares += Count > 1 ? Double3.Dot(now - velocity, now - velocity) : 0.0;
                velocity = now;
            }
            seconds = timeSeconds;
            place = placeMetres;
            ++Count;
        }
    }
}
