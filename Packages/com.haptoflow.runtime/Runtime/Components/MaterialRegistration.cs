#nullable enable
using HaptoFlow.Model;

namespace HaptoFlow
{
    /// <summary>One learnt material on its way into an engine. Made on the main thread, done by another.</summary>
    internal sealed class MaterialRegistration
    {
        /// <summary>The engine says where.</summary>
        public const int NewPlace = -1;

        private readonly string text;

        /// <param name="owner">Whose it is.</param>
        /// <param name="place">In the place of an earlier one, or <see cref="NewPlace"/>.</param>
        public MaterialRegistration(object owner, string text, int place)
        {
            Owner = owner;
            Place = place;
            this.text = text;
        }

        public object Owner { get; }

        /// <summary>Index of a label in the engine; <see cref="NewPlace"/> where a new one was refused.</summary>
        public int Place { get; private set; }

        public double StiffnessNewtonsPerMetre { get; private set; }

        /// <summary>Why it is not felt; null where it is.</summary>
        public string? Refusal { get; private set; }

        /// <summary>Why a material is not felt under a model of another space, and what to do.</summary>
        public static string ForeignSpace(string own, string models) =>
            $"it was learnt for another model (its space is {own}, the model's {models}). Learn it again from its " +
            "recording with this model, or choose the model that it was learnt for in Project Settings > HaptoFlow.";

        public void Do(HapticEngine engine, string space)
        {
            try
            {
                MaterialFile file = MaterialFile.Read(text);
                if (file.Space != space)
                {
                    Refusal = ForeignSpace(file.Space, space);
                    return;
                }
                StiffnessNewtonsPerMetre = file.StiffnessNewtonsPerMetre;
                if (Place == NewPlace)
                {
                    Place = engine.RegisterMaterial(text);
                }
                else
                {
                    engine.ReplaceMaterial(Place, text);
                }
            }
            catch (HaptoFlowException refusal)
            {
                Refusal = refusal.Message + ".";
            }
        }
    }
}
